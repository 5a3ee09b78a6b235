//! A nonlinear element: a law at a port.

use crate::{Law, Port};
use std::sync::Arc;

/// A nonlinear element: `law` acting through `port`.
#[derive(Debug, Clone)]
pub struct Element {
    /// Name by which results refer to the element.
    pub name: String,
    /// Where it acts.
    pub port: Port,
    /// What it does.
    pub law: Arc<dyn Law>,
}

impl Element {
    /// An element with the given law.
    pub fn new(name: impl Into<String>, port: Port, law: impl Law + 'static) -> Self {
        Self {
            name: name.into(),
            port,
            law: Arc::new(law),
        }
    }
}

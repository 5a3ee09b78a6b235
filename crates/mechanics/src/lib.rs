//! The mechanical system with ports and laws: the language between models and methods.
//!
//! ```text
//! M q'' + (C + Ω C₁) q' + (K + Ω² K₂) q + Σ_j b_j f_j(b_jᵀq, b_jᵀq') = F₀ + Σ_k (Fc_k cos kΩt + Fs_k sin kΩt)
//! ```
//!
//! A model (belt drive, clutch, matrices from a file) ends in a [`System`]; every method (exact flow, shooting,
//! harmonic balance) starts from one. A nonlinear [`Element`] acts through a [`Port`] and obeys a [`Law`], which tells
//! its force with tangents and, if it switches, its regimes as plain data ([`RegimeTable`]).

mod element;
mod forcing;
pub mod law;
pub mod laws;
mod linear;
mod operating_point;
mod output;
mod port;
mod system;

pub use element::Element;
pub use forcing::{Forcing, Harmonic};
pub use law::{
    Gradient, Guard, InternalRate, Law, Memory, MemoryResponse, Piece, Regime, RegimeTable, Response, Rest,
    Transition,
};
pub use linear::{Mode, modes};
pub use operating_point::{FrequencyFamily, OperatingPoint, OutsideDomain, SystemFamily};
pub use output::Output;
pub use port::Port;
pub use system::{System, SystemError};

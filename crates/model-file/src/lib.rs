//! Model files: TOML with units, schema and messages that point at the line.
//!
//! A [`Document`] is the text of a file and the overrides applied to it (`--set KEY=VALUE`). It gives a [`Model`], whose
//! values have passed all checks, and [`Warning`]s. A model becomes the equations of motion ([`Model::system`]) or, if it is
//! a [`drive`], the belt and pulleys that the mechanics of drives compute with ([`drive::Drive::belt_drive`]). Any of its
//! numbers can be read and changed by key path ([`Model::number`], [`Model::with_number`]), as continuation and parameter
//! studies need it. Every mistake is a [`ModelFileError`] that names file, line, key, value and remedy.
//!
//! Quantities are texts with units or bare numbers in SI; see [`units`]. [`schema()`] gives the JSON Schema of all kinds.
//!
//! # Testing against arbitrary texts
//! No text may cause a panic. `cargo test -p slackside-model-file` mutates the example files a few hundred times;
//! `SLACKSIDE_FUZZ_SECONDS=60 cargo test -p slackside-model-file fuzz -- --ignored` goes on for 60 seconds.

mod document;
pub mod drive;
mod error;
pub mod mechanical_system;
mod model;
mod names;
mod nearest;
mod node;
mod reader;
mod scalar;
mod schema;
mod smoothing;
mod source;
pub mod two_pulley_clutch;
pub mod units;
mod units_of_results;

pub use document::Document;
pub use error::{ModelFileError, Place, Problem, Scope, Warning};
pub use model::Model;
pub use schema::schema;
pub use smoothing::{Smoothing, SmoothingKind};
pub use units_of_results::Units;

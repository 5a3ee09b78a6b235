//! Physical quantities written as text, read into SI.
//!
//! `"88.9 mm"`, `"3000 rpm"`, `"0.5 N m/deg"`: a number followed by a product of units. Angle is kept as a dimension
//! of its own, so that a torque (`N m`) and a torsional stiffness (`N m/rad`) are told apart, and cycles and
//! revolutions count as angles: `"1 Hz"` is 2π rad/s, the angular frequency that the equations of motion need.
//!
//! ```
//! use slackside_model_file::units::{quantities, read};
//! assert_eq!(read("88.9 mm", &quantities::LENGTH), Ok(0.0889));
//! let error = read("4.5 N", &quantities::TORQUE).unwrap_err();
//! assert_eq!(error.to_string(), r#"expected a torque such as "4.5 N m", found "4.5 N""#);
//! ```

mod dimension;
mod expression;
mod product;
pub mod quantities;
mod quantity;
mod table;

pub use dimension::Dimension;
pub use expression::read;
pub use quantity::{Quantity, UnitError};

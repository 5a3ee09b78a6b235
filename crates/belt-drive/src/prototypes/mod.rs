//! The prototype drives of the literature.

mod three_pulley;
mod two_pulley;

pub use three_pulley::three_pulley;
pub use two_pulley::TwoPulley;

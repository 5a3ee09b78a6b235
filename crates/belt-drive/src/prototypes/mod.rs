//! The prototype drives of the literature.

mod two_pulley;

pub use two_pulley::TwoPulley;

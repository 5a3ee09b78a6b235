//! The questions a user asks: plan, run, collect.

//! The `slackside` program.
fn main() {}

//! Reference files and oracles for tests.

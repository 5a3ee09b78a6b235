//! Multi-term harmonic balance.

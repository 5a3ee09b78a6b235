//! Exact flow, events, periodic orbits, branches and attractors of mechanical systems.

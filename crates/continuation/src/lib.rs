//! Pseudo-arclength continuation of any residual F(u, p) = 0.

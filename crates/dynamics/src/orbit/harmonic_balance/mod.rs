//! Multi-term harmonic balance, condensed to the ports of the nonlinear elements (theory 02 §5, theory 05 §5.3).
//!
//! With `θ = Ωt/n` the displacement of port `i` is `u_i = h_0 + Re Σ_{k=1}^{H} h_k e^{ikθ}`. Each element is a linear spring
//! and damper plus a remainder force `N = f − k u − c v`; eliminating all coordinates leaves, per harmonic,
//!
//! ```text
//! r_k = u_k − u_lin,k + R_k N_k(u) = 0,        k = 0 … H,
//! ```
//!
//! with receptances `R_k = Bᵀ D_k⁻¹ B` and linear response `u_lin,k = Bᵀ D_k⁻¹ F_k`. The unknowns are
//! `(u_0, Re u_1, Im u_1, …, Re u_H, Im u_H)` of each nonlinear element in turn, however many coordinates the system has.
//!
//! A port whose mean displacement nothing holds (an accessory behind an overrunning clutch) drifts; its first unknown is the
//! mean velocity, and the mean of the equations determines it.
//!
//! [`solve`] finds one motion; [`HarmonicBalance`] is the same equations as a family to be followed in a parameter;
//! [`HarmonicOrbit`] is what is found: all coordinates, measures, events and stability.

mod balance;
mod condensed;
mod crossings;
pub(crate) mod elimination;
mod error;
mod family;
mod force;
mod graph;
mod layout;
mod linear_part;
mod linearization;
mod measures;
mod newton;
mod orbit;
mod settings;
mod stability;
mod tangent;

pub use error::HarmonicBalanceError;
pub use family::HarmonicBalance;
pub use newton::{Solution, SolveStop, Start, solve};
pub use orbit::HarmonicOrbit;
pub use settings::{Adaptation, ForceMethod, Settings};
pub use stability::{Stability, StabilityMethod};

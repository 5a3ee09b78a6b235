//! Gauss–Legendre quadrature on the unit interval.

use std::sync::OnceLock;

/// Number of nodes: exact for polynomials of degree 17.
pub const NODES: usize = 9;

/// Nodes and weights on `[0, 1]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Nodes, rising.
    pub nodes: [f64; NODES],
    /// Weights, of sum one.
    pub weights: [f64; NODES],
}

/// The rule with [`NODES`] nodes: zeros of the Legendre polynomial by Newton's method, computed once.
pub fn gauss_legendre() -> &'static Rule {
    static RULE: OnceLock<Rule> = OnceLock::new();
    RULE.get_or_init(|| {
        let mut rule = Rule {
            nodes: [0.0; NODES],
            weights: [0.0; NODES],
        };
        for i in 0..NODES {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (NODES as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut p, mut previous) = (x, 1.0);
                for k in 2..=NODES {
                    let next = ((2 * k - 1) as f64 * x * p - (k - 1) as f64 * previous) / k as f64;
                    (previous, p) = (p, next);
                }
                slope = NODES as f64 * (x * p - previous) / (x * x - 1.0);
                x -= p / slope;
            }
            rule.nodes[i] = 0.5 * (1.0 + x);
            rule.weights[i] = 1.0 / ((1.0 - x * x) * slope * slope);
        }
        rule
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_polynomials_up_to_its_degree() {
        let rule = gauss_legendre();
        for degree in 0..=17 {
            let sum: f64 = rule
                .nodes
                .iter()
                .zip(&rule.weights)
                .map(|(x, w)| w * x.powi(degree))
                .sum();
            assert!(
                (sum - 1.0 / (degree as f64 + 1.0)).abs() < 1e-15,
                "degree {degree}: {sum}"
            );
        }
    }
}

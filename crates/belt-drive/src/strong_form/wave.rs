//! Waves of one moving span at one frequency: the solutions of its equation of motion in closed form (theory 04 §4.6).

use crate::span::SpanEquilibrium;
use slackside_linalg::Complex;

/// Imaginary unit.
const I: Complex = Complex::new(0.0, 1.0);

/// The span as a continuum about its equilibrium.
#[derive(Debug, Clone, Copy)]
pub(super) struct Continuum {
    pub length: f64,
    /// `T`, N.
    pub tension: f64,
    /// `EI`, N·m²; zero for a string.
    pub bending: f64,
    /// `m`, kg/m.
    pub mass: f64,
    /// `c`, m/s.
    pub speed: f64,
    /// External damping `c_e` and drag `c_m`, N·s/m².
    pub external: f64,
    pub drag: f64,
    /// Slopes `w*'` of the equilibrium at both ends.
    pub slopes: [f64; 2],
    /// `λ`, 1/m, and the coefficients of `κ* = c_1 e^{−λx} + c_2 e^{−λ(L−x)}`, 1/m; zero for a string.
    lambda: f64,
    curvature: [f64; 2],
}

/// A term `coefficient · e^{exponent (x − origin)}`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Term {
    pub exponent: Complex,
    pub origin: f64,
    pub coefficient: Complex,
}

impl Term {
    /// The derivative of the given order at `x`.
    pub fn derivative(&self, x: f64, order: i32) -> Complex {
        self.coefficient * self.exponent.powi(order) * (self.exponent * (x - self.origin)).exp()
    }
}

/// Free waves of unit amplitude, and the forced wave that a unit of dynamic tension drives against the equilibrium curvature.
#[derive(Debug, Clone)]
pub(super) struct Waves {
    pub free: Vec<Term>,
    pub forced: Vec<Term>,
    /// The terms of `κ*`.
    pub curvature: Vec<Term>,
}

impl Continuum {
    /// The continuum of a span in equilibrium, with the ends at the tangent points. `curvatures` are `σ/r` at its ends.
    pub fn new(
        equilibrium: &SpanEquilibrium,
        length: f64,
        tension: f64,
        bending: f64,
        curvatures: [f64; 2],
        mass: f64,
        speed: f64,
    ) -> Self {
        let (lambda, curvature, slopes) = if bending > 0.0 {
            let lambda = (tension / bending).sqrt();
            let decay = (-lambda * length).exp();
            let both = 1.0 - decay * decay;
            let [start, end] = curvatures;
            let curvature = [(start - end * decay) / both, (end - start * decay) / both];
            (
                lambda,
                curvature,
                [equilibrium.slope(0.0), equilibrium.slope(length)],
            )
        } else {
            (0.0, [0.0; 2], [0.0; 2])
        };
        Self {
            length,
            tension,
            bending,
            mass,
            speed,
            external: 0.0,
            drag: 0.0,
            slopes,
            lambda,
            curvature,
        }
    }

    /// Number of free waves.
    pub fn order(&self) -> usize {
        if self.bending > 0.0 { 4 } else { 2 }
    }

    /// Coefficients of `μ` and `1` in `D(μ) = EI μ⁴ − T μ² + (2mciω + c_m c) μ − mω² + iω (c_e + c_m)`.
    fn low_coefficients(&self, frequency: Complex) -> (Complex, Complex) {
        (
            2.0 * self.mass * self.speed * I * frequency + self.drag * self.speed,
            -self.mass * frequency * frequency + I * frequency * (self.external + self.drag),
        )
    }

    /// The waves at a complex angular frequency with positive real part, for motions `e^{iωt}`.
    pub fn waves(&self, frequency: Complex) -> Waves {
        let (linear, constant) = self.low_coefficients(frequency);
        let mut exponents = self.undamped_exponents(frequency.norm());
        self.refine(&mut exponents, linear, constant);
        // Growing waves are measured from the far end, so that none exceeds one by much. The place in the list decides, not
        // the real part, which is rounding for the waves that travel: the choice must not change with the frequency.
        let free = exponents
            .into_iter()
            .enumerate()
            .map(|(index, exponent)| Term {
                exponent,
                origin: if index == 3 { self.length } else { 0.0 },
                coefficient: Complex::new(1.0, 0.0),
            })
            .collect();
        let mut curvature = Vec::new();
        if self.bending > 0.0 {
            for (exponent, origin, coefficient) in [
                (-self.lambda, 0.0, self.curvature[0]),
                (self.lambda, self.length, self.curvature[1]),
            ] {
                curvature.push(Term {
                    exponent: exponent.into(),
                    origin,
                    coefficient: coefficient.into(),
                });
            }
        }
        // EI λ⁴ = T λ² leaves the low coefficients of D(±λ).
        let forced = curvature
            .iter()
            .map(|term| Term {
                coefficient: term.coefficient / (linear * term.exponent + constant),
                ..*term
            })
            .collect();
        Waves {
            free,
            forced,
            curvature,
        }
    }

    /// Exponents without damping at a real frequency: two travelling waves, and for a beam one that decays and one that grows.
    ///
    /// With `μ = iν`, `EI ν⁴ + T ν² − 2mcω ν − mω²` is convex and negative at zero: one positive and one negative root, to
    /// which Newton's method runs down from those of the string.
    fn undamped_exponents(&self, frequency: f64) -> Vec<Complex> {
        let (m, c, t, ei) = (self.mass, self.speed, self.tension, self.bending);
        let wave_speed = (c * c + t / m).sqrt();
        // −ω/(c_0 + c) and ω/(c_0 − c), with c_0² − c² = T/m.
        let travelling = [
            frequency * m * (wave_speed + c) / t,
            -frequency / (wave_speed + c),
        ];
        if ei == 0.0 {
            return travelling.iter().map(|nu| I * *nu).collect();
        }
        let value =
            |nu: f64| ei * nu.powi(4) + t * nu * nu - 2.0 * m * c * frequency * nu - m * frequency.powi(2);
        let slope = |nu: f64| 4.0 * ei * nu.powi(3) + 2.0 * t * nu - 2.0 * m * c * frequency;
        let [forward, backward] = travelling.map(|start| {
            let mut nu = start;
            for _ in 0..100 {
                let next = nu - value(nu) / slope(nu);
                // Rounding ends the monotone descent.
                if next.abs() >= nu.abs() {
                    break;
                }
                nu = next;
            }
            nu
        });
        // The other two: the sum of all roots is zero, the sum of their products in pairs T/EI.
        let sum = forward + backward;
        let product = t / ei - forward * backward + sum * sum;
        let decay = (product - 0.25 * sum * sum).sqrt();
        vec![
            I * forward,
            I * backward,
            Complex::new(-decay, -0.5 * sum),
            Complex::new(decay, -0.5 * sum),
        ]
    }

    /// Roots of `D` next to the given ones, all at once (Aberth's iteration).
    fn refine(&self, exponents: &mut [Complex], linear: Complex, constant: Complex) {
        for _ in 0..50 {
            let mut worst = 0.0_f64;
            for k in 0..exponents.len() {
                let mu = exponents[k];
                let squared = mu * mu;
                let value = squared * (self.bending * squared - self.tension) + linear * mu + constant;
                let slope = mu * (4.0 * self.bending * squared - 2.0 * self.tension) + linear;
                let newton = value / slope;
                let repulsion: Complex = (0..exponents.len())
                    .filter(|other| *other != k)
                    .map(|other| (mu - exponents[other]).inv())
                    .sum();
                let step = newton / (1.0 - newton * repulsion);
                if !step.is_finite() {
                    continue;
                }
                exponents[k] -= step;
                worst = worst.max(step.norm() / mu.norm());
            }
            if worst < 1e-15 {
                break;
            }
        }
    }

    /// `[w*' w]_0^L − ∫ κ* w dx`, the stretch by a wave against the equilibrium shape, m per unit (theory 04 §4.6).
    pub fn stretch(&self, waves: &Waves, term: &Term) -> Complex {
        let ends =
            self.slopes[1] * term.derivative(self.length, 0) - self.slopes[0] * term.derivative(0.0, 0);
        let area: Complex = waves
            .curvature
            .iter()
            .map(|curvature| product_integral(curvature, term, self.length))
            .sum();
        ends - area
    }

    /// `T w' − m c iω w − EI w'''` of a term at `x`: the transverse force without the part of the dynamic tension along the
    /// equilibrium slope (theory 04 (3.6)).
    pub fn transverse_force(&self, term: &Term, x: f64, frequency: Complex) -> Complex {
        self.tension * term.derivative(x, 1)
            - I * frequency * self.mass * self.speed * term.derivative(x, 0)
            - self.bending * term.derivative(x, 3)
    }
}

/// `∫_0^L` of the product of two terms.
fn product_integral(a: &Term, b: &Term, length: f64) -> Complex {
    let exponent_at = |x: f64| a.exponent * (x - a.origin) + b.exponent * (x - b.origin);
    let (start, end) = (exponent_at(0.0), exponent_at(length));
    let difference = end - start;
    // From the end where the product is larger, so that nothing overflows.
    let integral = if difference.re > 0.0 {
        end.exp() * relative_growth(-difference)
    } else {
        start.exp() * relative_growth(difference)
    };
    a.coefficient * b.coefficient * length * integral
}

/// `(e^z − 1)/z`.
fn relative_growth(z: Complex) -> Complex {
    if z.norm() > 0.7 {
        return (z.exp() - 1.0) / z;
    }
    let (mut sum, mut term) = (Complex::new(1.0, 0.0), Complex::new(1.0, 0.0));
    for k in 2..22 {
        term *= z / f64::from(k);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::SpanEnds;

    fn continuum(bending: f64, speed: f64) -> Continuum {
        let curvatures = [20.0, -30.0];
        let equilibrium = SpanEquilibrium::new(0.35, 300.0, bending, curvatures, SpanEnds::Tangent);
        Continuum::new(&equilibrium, 0.35, 300.0, bending, curvatures, 0.1, speed)
    }

    #[test]
    fn exponents_are_roots_with_and_without_damping() {
        for (bending, speed) in [(0.0, 0.0), (0.0, 25.0), (0.02, 0.0), (0.02, 25.0)] {
            let mut span = continuum(bending, speed);
            for (damping, frequency) in [(0.0, Complex::new(700.0, 0.0)), (3.0, Complex::new(700.0, 20.0))] {
                (span.external, span.drag) = (damping, 0.5 * damping);
                let (linear, constant) = span.low_coefficients(frequency);
                let waves = span.waves(frequency);
                assert_eq!(waves.free.len(), span.order());
                for term in &waves.free {
                    let mu = term.exponent;
                    let parts = [bending * mu.powi(4), -300.0 * mu.powi(2), linear * mu, constant];
                    let size: f64 = parts.iter().map(|part| part.norm()).sum();
                    let value: Complex = parts.iter().sum();
                    assert!(value.norm() < 1e-14 * size, "{value} of {size}");
                }
            }
        }
    }

    #[test]
    fn forced_wave_satisfies_the_equation_of_motion() {
        let span = continuum(0.02, 25.0);
        let frequency = Complex::new(500.0, 0.0);
        let waves = span.waves(frequency);
        let at = |x: f64, order: i32| -> Complex {
            waves.forced.iter().map(|term| term.derivative(x, order)).sum()
        };
        for x in [0.0, 0.001, 0.1, 0.349] {
            let left = 0.02 * at(x, 4) - 300.0 * at(x, 2) + 2.0 * 0.1 * 25.0 * I * frequency * at(x, 1)
                - 0.1 * frequency * frequency * at(x, 0);
            let right: Complex = waves.curvature.iter().map(|term| term.derivative(x, 0)).sum();
            assert!(
                (left - right).norm() < 1e-9 * (right.norm() + 1.0),
                "{left} {right}"
            );
        }
    }

    #[test]
    fn integrals_of_products_agree_with_quadrature() {
        let span = continuum(0.02, 25.0);
        let waves = span.waves(Complex::new(500.0, 0.0));
        let count = 40_000;
        let step = 0.35 / f64::from(count);
        for term in &waves.free {
            for curvature in &waves.curvature {
                let sum: Complex = (0..count)
                    .map(|k| {
                        let x = (f64::from(k) + 0.5) * step;
                        curvature.derivative(x, 0) * term.derivative(x, 0)
                    })
                    .sum();
                let closed = product_integral(curvature, term, 0.35);
                assert!((sum * step - closed).norm() < 1e-6, "{} {closed}", sum * step);
            }
        }
    }
}

//! Lower bounds on the real part of the mobility over all frequencies, by branch and bound.
//!
//! With poles and residues the first derivative is known and the second is bounded on an interval by the distance to the poles,
//! `|d²/dω² Σ ρ/(iω − λ)| ≤ Σ 2|ρ| / dist(λ, interval)³`, so that a value and a slope at the middle bound the whole
//! interval. Beyond the last pole the expansion `Re Y = −Σ ρλ/ω² + O(ω⁻⁴)` with its remainder decides.

use super::{Mobility, ReceptanceError};
use slackside_linalg::{Complex, ComplexMatrix, LinalgError, Matrix, symmetric_eigenvalues};

/// Largest number of intervals that are looked at.
const BUDGET: usize = 200_000;

/// Smallest eigenvalue of the Hermitian part `(Y + Yᴴ)/2` of the mobility over a range of frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RealPart {
    /// The smallest value found, velocity per force.
    pub minimum: f64,
    /// Circular frequency at which it is found.
    pub omega: f64,
    /// What is proved: no value on the range is below this.
    pub lower_bound: f64,
}

impl Mobility {
    /// The smallest real part on `from ≤ ω ≤ to`, to `1e-9` of its value (or to `1e-12` of the largest mobility there).
    ///
    /// # Errors
    /// [`ReceptanceError::Linalg`] if an eigenvalue iteration fails.
    pub fn smallest_real_part(&self, from: f64, to: f64) -> Result<RealPart, ReceptanceError> {
        let terms = Terms::new(self, 0);
        let size = terms.magnitude(from, to);
        let mut found = RealPart {
            minimum: f64::INFINITY,
            omega: from,
            lower_bound: f64::INFINITY,
        };
        let enough = |lower: f64, best: f64| lower >= best - (1e-9 * best.abs()).max(1e-12 * size);
        terms.explore(from, to, &enough, &mut found)?;
        Ok(found)
    }

    /// Whether the real part of the mobility is positive definite for every `ω > 0`: `Some(true)` is a proof up to rounding in
    /// the poles, `Some(false)` comes with a frequency at which it is not, `None` is undecided. Where every port has static
    /// stiffness, `Y(0) = 0` and `Re Y / ω²` is bounded instead, which has a limit there.
    ///
    /// # Errors
    /// [`ReceptanceError::Linalg`] if an eigenvalue iteration fails.
    pub fn is_positive_real(&self) -> Result<(Option<bool>, f64), ReceptanceError> {
        if self.poles.iter().any(|pole| pole.re >= 0.0) {
            return Ok((None, 0.0));
        }
        if self.has_static_stiffness && !self.static_receptance_is_symmetric() {
            // iω (R_0 − R_0ᵀ)/2 is indefinite and, as ω → 0, larger than what damping gives.
            return Ok((Some(false), 0.0));
        }
        let terms = Terms::new(self, if self.has_static_stiffness { 2 } else { 0 });
        let Some(tail) = self.tail()? else {
            return Ok((None, f64::INFINITY));
        };
        let mut found = RealPart {
            minimum: f64::INFINITY,
            omega: 0.0,
            lower_bound: f64::INFINITY,
        };
        let enough = |lower: f64, best: f64| lower > 0.0 || best <= 0.0;
        terms.explore(0.0, tail, &enough, &mut found)?;
        // Rounding of the poles and residues moves the sum by about its measured error.
        let rounding = 4.0 * self.error * terms.magnitude(found.omega, found.omega);
        let verdict = if found.lower_bound > 0.0 && found.minimum > rounding {
            Some(true)
        } else if found.minimum < -rounding {
            Some(false)
        } else {
            None
        };
        Ok((verdict, found.omega))
    }

    /// Whether `R_0 = −Σ ρ/λ²` is symmetric to ten digits, which one port always is.
    fn static_receptance_is_symmetric(&self) -> bool {
        let m = self.residues.first().map_or(0, ComplexMatrix::rows);
        let entry = |i: usize, j: usize| -> Complex {
            let terms = self.poles.iter().zip(&self.residues);
            terms
                .map(|(pole, residue)| -residue[(i, j)] / (pole * pole))
                .sum()
        };
        (0..m).all(|i| {
            (0..i).all(|j| {
                let (a, b) = (entry(i, j).re, entry(j, i).re);
                (a - b).abs() <= 1e-10 * (entry(i, i).re * entry(j, j).re).abs().sqrt()
            })
        })
    }

    /// The frequency beyond which `Re Y` is certainly positive definite, if its leading term is.
    fn tail(&self) -> Result<Option<f64>, ReceptanceError> {
        let m = self.residues.first().map_or(0, ComplexMatrix::rows);
        let mut leading = ComplexMatrix::zeros(m, m);
        let (mut remainder, mut highest) = (0.0, 0.0_f64);
        for (pole, residue) in self.poles.iter().zip(&self.residues) {
            for i in 0..m {
                for j in 0..m {
                    leading[(i, j)] -= residue[(i, j)] * pole;
                }
            }
            remainder += frobenius(residue) * pole.norm().powi(3);
            highest = highest.max(pole.norm());
        }
        let gamma = smallest_eigenvalue(&leading)?;
        // ω² Re Y ≥ γ − 2 Σ|ρ||λ|³/ω² for ω ≥ 2 max|λ|.
        Ok((gamma > 0.0).then(|| (2.0 * highest).max(1.01 * (2.0 * remainder / gamma).sqrt())))
    }
}

/// `Σ a_p / (iω − λ_p)`, with `a_p = ρ_p` for `Re Y` itself or `−ρ_p/λ_p²` for `Re Y / ω²`.
struct Terms<'a> {
    poles: &'a [Complex],
    residues: Vec<ComplexMatrix>,
    sizes: Vec<f64>,
}

impl<'a> Terms<'a> {
    fn new(mobility: &'a Mobility, divided_by_power: u8) -> Self {
        let factor = |pole: &Complex| {
            if divided_by_power == 2 {
                -(pole * pole).inv()
            } else {
                Complex::ONE
            }
        };
        let residues: Vec<ComplexMatrix> = (mobility.poles.iter().zip(&mobility.residues))
            .map(|(pole, residue)| {
                let mut scaled = residue.clone();
                for i in 0..residue.rows() {
                    for j in 0..residue.columns() {
                        scaled[(i, j)] *= factor(pole);
                    }
                }
                scaled
            })
            .collect();
        Self {
            poles: &mobility.poles,
            sizes: residues.iter().map(frobenius).collect(),
            residues,
        }
    }

    /// Bound on the size of the sum on an interval.
    fn magnitude(&self, from: f64, to: f64) -> f64 {
        let terms = self.poles.iter().zip(&self.sizes);
        terms.map(|(pole, a)| a / distance(pole, from, to)).sum()
    }

    /// Bound on its second derivative on an interval.
    fn curvature(&self, from: f64, to: f64) -> f64 {
        let terms = self.poles.iter().zip(&self.sizes);
        terms
            .map(|(pole, a)| 2.0 * a / distance(pole, from, to).powi(3))
            .sum()
    }

    /// Smallest eigenvalue of the Hermitian part, and a bound on how fast it changes.
    fn value_and_slope(&self, omega: f64) -> Result<(f64, f64), LinalgError> {
        let m = self.residues.first().map_or(0, ComplexMatrix::rows);
        let mut value = ComplexMatrix::zeros(m, m);
        let mut slope = ComplexMatrix::zeros(m, m);
        for (pole, residue) in self.poles.iter().zip(&self.residues) {
            let factor = (Complex::new(0.0, omega) - pole).inv();
            let rate = -Complex::I * factor * factor;
            for i in 0..m {
                for j in 0..m {
                    value[(i, j)] += residue[(i, j)] * factor;
                    slope[(i, j)] += residue[(i, j)] * rate;
                }
            }
        }
        if m == 1 {
            return Ok((value[(0, 0)].re, slope[(0, 0)].re.abs()));
        }
        let mut hermitian = ComplexMatrix::zeros(m, m);
        for i in 0..m {
            for j in 0..m {
                hermitian[(i, j)] = 0.5 * (slope[(i, j)] + slope[(j, i)].conj());
            }
        }
        Ok((smallest_eigenvalue(&value)?, frobenius(&hermitian)))
    }

    /// Divides the range until every interval is bounded well `enough` from below.
    fn explore(
        &self,
        from: f64,
        to: f64,
        enough: &dyn Fn(f64, f64) -> bool,
        found: &mut RealPart,
    ) -> Result<(), LinalgError> {
        for omega in [from, to] {
            let (value, _) = self.value_and_slope(omega)?;
            if value < found.minimum {
                (found.minimum, found.omega) = (value, omega);
            }
        }
        let mut edges: Vec<f64> = (self.poles.iter().map(|pole| pole.im))
            .filter(|&omega| omega > from && omega < to)
            .chain([from, to])
            .collect();
        edges.sort_by(f64::total_cmp);
        let mut open: Vec<(f64, f64)> = edges.windows(2).map(|w| (w[0], w[1])).collect();
        let mut spent = 0;
        while let Some((a, b)) = open.pop() {
            spent += 1;
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            let (value, slope) = self.value_and_slope(middle)?;
            if value < found.minimum {
                (found.minimum, found.omega) = (value, middle);
            }
            let lower = value - half * (slope + 0.5 * half * self.curvature(a, b));
            if enough(lower, found.minimum) || half <= 1e-14 * middle {
                found.lower_bound = found.lower_bound.min(lower);
            } else if spent > BUDGET {
                found.lower_bound = f64::NEG_INFINITY;
                return Ok(());
            } else {
                open.push((middle, b));
                open.push((a, middle));
            }
        }
        found.lower_bound = found.lower_bound.min(found.minimum);
        Ok(())
    }
}

/// Distance of a pole from the stretch `i [from, to]` of the imaginary axis.
fn distance(pole: &Complex, from: f64, to: f64) -> f64 {
    pole.re.hypot(pole.im - pole.im.clamp(from, to))
}

fn frobenius(matrix: &ComplexMatrix) -> f64 {
    let entries = (0..matrix.rows()).flat_map(|i| (0..matrix.columns()).map(move |j| (i, j)));
    entries.map(|at| matrix[at].norm_sqr()).sum::<f64>().sqrt()
}

/// Smallest eigenvalue of the Hermitian part, from the real symmetric matrix `[[Re, −Im], [Im, Re]]`.
fn smallest_eigenvalue(matrix: &ComplexMatrix) -> Result<f64, LinalgError> {
    let m = matrix.rows();
    let mut real = Matrix::zeros(2 * m, 2 * m);
    for i in 0..m {
        for j in 0..m {
            let h = 0.5 * (matrix[(i, j)] + matrix[(j, i)].conj());
            real[(i, j)] = h.re;
            real[(m + i, m + j)] = h.re;
            real[(i, m + j)] = -h.im;
            real[(m + i, j)] = h.im;
        }
    }
    Ok(symmetric_eigenvalues(&real)?.first().copied().unwrap_or(0.0))
}

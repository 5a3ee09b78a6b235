//! The derivative of the forces' harmonics with respect to those of the displacement: Toeplitz plus Hankel.

use super::force::PortForce;
use num_complex::Complex;
use slackside_linalg::Matrix;

/// `∂N/∂u` in real form. With `P = G_{k−l} + ilω G'_{k−l}` and `Q = G_{k+l} − ilω G'_{k+l}` (`G` of `∂N/∂u`, `G'` of `∂N/∂v`):
/// `δN_k = 2 G_k δu_0 + Σ_{l≥1} (P δu_l + Q δu_l*)`. The first unknown of a port that drifts is its mean velocity, which takes
/// `G'_k` in place of `G_k`.
pub fn fill_tangent(force: &PortForce, harmonics: usize, omega: f64, drifts: bool, tangent: &mut Matrix) {
    if let Some(direct) = &force.direct {
        tangent.as_mut_slice().copy_from_slice(direct.matrix.as_slice());
        return;
    }
    tangent.fill(0.0);
    let at = |coefficients: &[Complex<f64>], k: usize, l: usize| {
        if k >= l {
            coefficients[k - l]
        } else {
            coefficients[l - k].conj()
        }
    };
    for (coefficients, is_rate) in [(&force.by_displacement, false), (&force.by_velocity, true)] {
        if coefficients.is_empty() {
            continue;
        }
        let factor = |l: usize| match is_rate {
            true => Complex::new(0.0, l as f64 * omega),
            false => Complex::ONE,
        };
        let moves_mean = is_rate == drifts;
        if moves_mean {
            tangent[(0, 0)] += coefficients[0].re;
        }
        let first = tangent.row_mut(0);
        for l in 1..=harmonics {
            let weight = coefficients[l].conj() * factor(l);
            first[2 * l - 1] += weight.re;
            first[2 * l] -= weight.im;
        }
        for k in 1..=harmonics {
            let rows =
                &mut tangent.as_mut_slice()[(2 * k - 1) * (2 * harmonics + 1)..][..2 * (2 * harmonics + 1)];
            let (real, imaginary) = rows.split_at_mut(2 * harmonics + 1);
            if moves_mean {
                real[0] += 2.0 * coefficients[k].re;
                imaginary[0] += 2.0 * coefficients[k].im;
            }
            for l in 1..=harmonics {
                let (mut p, mut q) = (at(coefficients, k, l), coefficients[k + l]);
                if is_rate {
                    p *= factor(l);
                    q *= factor(l).conj();
                }
                real[2 * l - 1] += p.re + q.re;
                real[2 * l] += q.im - p.im;
                imaginary[2 * l - 1] += p.im + q.im;
                imaginary[2 * l] += p.re - q.re;
            }
        }
    }
}

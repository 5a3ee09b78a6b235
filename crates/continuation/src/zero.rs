//! A bracketed zero of a function whose evaluation may fail.

/// Brent's method (inverse quadratic interpolation and secant steps, safeguarded by bisection) for a zero in `[a, b]`,
/// where the function has the values `fa` and `fb` of opposite sign. Ends when the bracket is shorter than
/// `tolerance · (b − a)`, or when an evaluation fails; the caller keeps the best evaluation.
pub(crate) fn brent(
    a: f64,
    b: f64,
    fa: f64,
    fb: f64,
    tolerance: f64,
    evaluate: &mut dyn FnMut(f64) -> Option<f64>,
) {
    let minimum = tolerance * (b - a).abs();
    let (mut a, mut b, mut fa, mut fb) = (a, b, fa, fb);
    if fa.abs() < fb.abs() {
        std::mem::swap(&mut a, &mut b);
        std::mem::swap(&mut fa, &mut fb);
    }
    let (mut c, mut fc) = (a, fa);
    let (mut bisected, mut before_last) = (true, 0.0_f64);
    for _ in 0..80 {
        if fb == 0.0 || (b - a).abs() <= minimum {
            return;
        }
        let mut s = if fa != fc && fb != fc {
            a * fb * fc / ((fa - fb) * (fa - fc))
                + b * fa * fc / ((fb - fa) * (fb - fc))
                + c * fa * fb / ((fc - fa) * (fc - fb))
        } else {
            b - fb * (b - a) / (fb - fa)
        };
        let (low, high) = if a < b {
            (0.75 * a + 0.25 * b, b)
        } else {
            (b, 0.75 * a + 0.25 * b)
        };
        let last = if bisected { (b - c).abs() } else { before_last };
        if !(s > low && s < high) || (s - b).abs() >= 0.5 * last || last < minimum {
            s = 0.5 * (a + b);
            bisected = true;
        } else {
            bisected = false;
        }
        // An estimate closer than the tolerance moves by it, so that the bracket closes from both sides.
        if (s - b).abs() < minimum {
            s = b + minimum.copysign(a - b);
        }
        let Some(fs) = evaluate(s) else { return };
        if fs.is_nan() {
            return;
        }
        before_last = (b - c).abs();
        (c, fc) = (b, fb);
        if fa * fs < 0.0 {
            (b, fb) = (s, fs);
        } else {
            (a, fa) = (s, fs);
        }
        if fa.abs() < fb.abs() {
            std::mem::swap(&mut a, &mut b);
            std::mem::swap(&mut fa, &mut fb);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::brent;

    #[test]
    fn finds_the_zero_in_few_evaluations() {
        let mut count = 0;
        let mut best = (f64::INFINITY, 0.0);
        brent(0.0, 2.0, -2.0, 2.0_f64.powi(3) - 2.0, 1e-15, &mut |x| {
            count += 1;
            let f = x * x * x - 2.0;
            if f.abs() < best.0 {
                best = (f.abs(), x);
            }
            Some(f)
        });
        assert!((best.1 - 2.0_f64.cbrt()).abs() < 1e-14, "{best:?}");
        assert!(count < 20, "{count} evaluations");
    }

    #[test]
    fn ends_when_an_evaluation_fails() {
        let mut count = 0;
        brent(0.0, 1.0, -1.0, 1.0, 1e-12, &mut |_| {
            count += 1;
            None
        });
        assert_eq!(count, 1);
    }
}

//! The root of a monotone function of one variable between two values of opposite sign.

/// Root of `f` between `low` and `high`, to rounding, by false position with halved weights (Anderson and Björck), with a
/// bisection whenever three such steps have not halved the bracket. `f(low)` and `f(high)` must differ in sign or vanish.
pub(super) fn root(low: f64, high: f64, f: &mut dyn FnMut(f64) -> f64) -> f64 {
    let (mut a, mut b) = (low, high);
    let (mut fa, mut fb) = (f(a), f(b));
    if fa == 0.0 {
        return a;
    }
    let mut width = (b - a).abs();
    for count in 1..300 {
        if fb == 0.0 || (b - a).abs() <= 2.0 * f64::EPSILON * a.abs().max(b.abs()) {
            break;
        }
        let mut next = b - fb * (b - a) / (fb - fa);
        if count % 3 == 0 {
            if (b - a).abs() > 0.5 * width {
                next = 0.5 * (a + b);
            }
            width = (b - a).abs();
        }
        if !(next > a.min(b) && next < a.max(b)) {
            next = 0.5 * (a + b);
            if next == a || next == b {
                break;
            }
        }
        let value = f(next);
        if value * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            let share = 1.0 - value / fb;
            fa *= if share > 0.0 { share } else { 0.5 };
        }
        (b, fb) = (next, value);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::root;

    #[test]
    fn finds_roots_of_bent_and_steep_functions() {
        for (target, power) in [(0.3_f64, 1), (0.9, 9), (1e-3, 3), (7.0, 15)] {
            let mut calls = 0;
            let found = root(0.0, 10.0, &mut |x| {
                calls += 1;
                x.powi(power) - target.powi(power)
            });
            assert!((found / target - 1.0).abs() < 1e-14, "{found} for {target}");
            assert!(calls < 120, "{calls} evaluations");
        }
        assert_eq!(root(0.0, 1.0, &mut |x| x), 0.0);
        assert_eq!(root(-1.0, 0.0, &mut |x| x), 0.0);
    }
}

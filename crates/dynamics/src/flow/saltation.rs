//! What a variation suffers at an event (theory 05 §3.5).

/// The saltation matrix `S = I + (f₊ − f₋) gᵀ / (gᵀ f₋)` of an event with continuous state, as a rank-one update.
#[derive(Debug, Clone)]
pub(crate) struct Saltation {
    /// `(f₊ − f₋) / (gᵀ f₋)`, or empty if the vector field is continuous, so that `S = I`.
    jump: Vec<f64>,
    normal: Vec<f64>,
}

impl Saltation {
    /// From the vector fields before and after the event and the guard's gradient, all on the mechanical state, and the
    /// rate `speed` at which the guard falls, to which the load may contribute.
    pub fn new(before: &[f64], after: &[f64], normal: &[f64], speed: f64) -> Self {
        let size = before.iter().chain(after).fold(0.0_f64, |a, v| a.max(v.abs()));
        // The two fields are computed by different sums: equal up to rounding means continuous.
        let continuous = before
            .iter()
            .zip(after)
            .all(|(b, a)| (a - b).abs() <= 1e-12 * size);
        if continuous || speed == 0.0 {
            return Self {
                jump: Vec::new(),
                normal: Vec::new(),
            };
        }
        let jump = before.iter().zip(after).map(|(b, a)| (a - b) / speed).collect();
        Self {
            jump,
            normal: normal.to_vec(),
        }
    }

    /// Whether `S = I`.
    pub fn is_identity(&self) -> bool {
        self.jump.is_empty()
    }

    /// `column ← S column`. `shift` is what the guard itself gains besides (its derivative with respect to the parameter,
    /// for the column that is one).
    pub fn apply(&self, column: &mut [f64], shift: f64) {
        if self.is_identity() {
            return;
        }
        let along: f64 = shift
            + self
                .normal
                .iter()
                .zip(column.iter())
                .map(|(g, y)| g * y)
                .sum::<f64>();
        for (y, jump) in column.iter_mut().zip(&self.jump) {
            *y += jump * along;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_continuous_field_gives_the_identity() {
        let field = [0.3, -0.2, 1.0, 2.0];
        let saltation = Saltation::new(&field, &field, &[1.0, -1.0, 0.0, 0.0], 0.5);
        assert!(saltation.is_identity());
        let mut column = [1.0, 2.0, 3.0, 4.0];
        saltation.apply(&mut column, 0.0);
        assert_eq!(column, [1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn a_jump_of_the_field_maps_the_field_before_to_the_field_after() {
        let (before, after) = ([0.5, -1.0], [0.5, 2.0]);
        let saltation = Saltation::new(&before, &after, &[1.0, 0.3], 0.2);
        assert!(!saltation.is_identity());
        let mut column = before;
        saltation.apply(&mut column, 0.0);
        assert!((column[0] - after[0]).abs() < 1e-15 && (column[1] - after[1]).abs() < 1e-15);
    }
}

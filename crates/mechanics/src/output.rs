//! Linear measures of the motion.

/// A linear measure of the motion:
/// `y = constant + Σ a_i q_i + Σ b_i q'_i + Σ g_j f_j + Σ_k (c_k cos kΩt + s_k sin kΩt)`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Output {
    /// Name by which results refer to the measure.
    pub name: String,
    /// Constant part.
    pub constant: f64,
    /// Factors of coordinates: index and factor.
    pub displacement: Vec<(usize, f64)>,
    /// Factors of coordinate rates: index and factor.
    pub velocity: Vec<(usize, f64)>,
    /// Factors of element forces: index of the element and factor.
    pub force: Vec<(usize, f64)>,
    /// Prescribed harmonic parts: order, cosine and sine amplitude.
    pub harmonics: Vec<(usize, f64, f64)>,
}

impl Output {
    /// The measure "coordinate `index`".
    pub fn coordinate(name: impl Into<String>, index: usize) -> Self {
        Self {
            name: name.into(),
            displacement: vec![(index, 1.0)],
            ..Self::default()
        }
    }

    /// The measure "force of element `index`".
    pub fn element_force(name: impl Into<String>, index: usize) -> Self {
        Self {
            name: name.into(),
            force: vec![(index, 1.0)],
            ..Self::default()
        }
    }
}

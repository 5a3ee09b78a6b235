//! Conditions of service in which the same drive is examined: new and worn, cold and hot, short and long belts.

/// What differs from the drive as installed.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// Name, for tables and figures.
    pub name: String,
    /// Temperature above that of the installation, K; expands the belt and the structure by their coefficients.
    pub temperature_change: f64,
    /// Change of the natural belt length, m: a tolerance of manufacture.
    pub length_change: f64,
    /// Lasting elongation of the belt as a strain: wear.
    pub elongation: f64,
    /// Thermal expansion of the structure that holds the pulleys, 1/K.
    pub structure_expansion: f64,
    /// Factor on the spring torque of every tensioner: ageing and tolerance.
    pub spring_factor: f64,
}

impl Condition {
    /// The drive as installed.
    pub fn nominal(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            temperature_change: 0.0,
            length_change: 0.0,
            elongation: 0.0,
            structure_expansion: 0.0,
            spring_factor: 1.0,
        }
    }
}

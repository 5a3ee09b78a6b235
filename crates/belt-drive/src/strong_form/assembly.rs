//! The linear system of the strong form at one frequency.
//!
//! Unknowns, in this order: for every span the amplitudes of its free waves and its dynamic tension `p_i`; the rotations of
//! the pulleys; those of the accessories; the positions of the arms. Equations in the same order: the end conditions of a
//! span and its stretch, then the balances. Where a motion is prescribed, the torque that enforces it takes its place.

use super::{DriverMotion, HarmonicLoad, StrongForm};
use slackside_linalg::{Complex, ComplexMatrix};

const I: Complex = Complex::new(0.0, 1.0);

/// Factors that make the entries of the system comparable: unknowns are in units of `columns`, equations are multiplied by
/// `rows`.
pub(super) struct Scales {
    pub columns: Vec<f64>,
    pub rows: Vec<f64>,
}

impl StrongForm<'_> {
    fn stride(&self) -> usize {
        self.continua.first().map_or(0, |span| span.order() + 1)
    }

    /// Place of the first wave of a span.
    pub(super) fn wave_index(&self, span: usize) -> usize {
        span * self.stride()
    }

    /// Place of the dynamic tension of a span.
    pub(super) fn tension_index(&self, span: usize) -> usize {
        (span + 1) * self.stride() - 1
    }

    /// Place of the rotation of a pulley.
    pub(super) fn pulley_index(&self, pulley: usize) -> usize {
        self.continua.len() * self.stride() + pulley
    }

    /// Place of the rotation of an accessory, counted among those with one of their own.
    pub(super) fn accessory_index(&self, accessory: usize) -> usize {
        self.pulley_index(self.drive.pulleys.len()) + accessory
    }

    /// Place of the position of an arm.
    pub(super) fn arm_index(&self, arm: usize) -> usize {
        self.accessory_index(self.accessories.len()) + arm
    }

    fn dimension(&self) -> usize {
        self.arm_index(self.drive.tensioners.len())
    }

    /// Places of the coordinates whose motion is prescribed.
    fn prescribed(&self) -> Vec<usize> {
        let mut places = Vec::new();
        if self.configuration.driver == DriverMotion::Prescribed {
            places.push(self.pulley_index(self.drive.driver));
        }
        for arm in 0..self.drive.tensioners.len() {
            if self.is_held(arm) {
                places.push(self.arm_index(arm));
            }
        }
        places
    }

    /// Scales at a frequency.
    pub(super) fn scales(&self, frequency: Complex) -> Scales {
        let count = self.continua.len() as f64;
        let length: f64 = self.continua.iter().map(|span| span.length).sum::<f64>() / count;
        let force: f64 = self.continua.iter().map(|span| span.tension).sum::<f64>() / count;
        let mut columns = vec![length; self.dimension()];
        for span in 0..self.continua.len() {
            columns[self.tension_index(span)] = force;
        }
        for (j, pulley) in self.drive.pulleys.iter().enumerate() {
            columns[self.pulley_index(j)] = length / pulley.radius;
        }
        for (place, (j, _)) in self.accessories.iter().enumerate() {
            columns[self.accessory_index(place)] = length / self.drive.pulleys[*j].radius;
        }
        for arm in 0..self.drive.tensioners.len() {
            let lever = self
                .drive
                .carried_by(arm)
                .map(|j| self.steady.kinematics.centre_rates[j][arm].length())
                .fold(0.0, f64::max);
            columns[self.arm_index(arm)] = if lever > 0.0 { length / lever } else { 1.0 };
        }
        for place in self.prescribed() {
            columns[place] = force * length;
        }
        let mut scales = Scales {
            columns,
            rows: vec![1.0; self.dimension()],
        };
        let system = self.system(frequency, &scales);
        for (i, scale) in scales.rows.iter_mut().enumerate() {
            let largest =
                (0..system.columns()).fold(0.0_f64, |largest, j| largest.max(system[(i, j)].norm()));
            if largest > 0.0 {
                *scale = 1.0 / largest;
            }
        }
        scales
    }

    /// The scaled matrix `N(ω)`, with reactions in the place of prescribed motions.
    pub(super) fn system(&self, frequency: Complex, scales: &Scales) -> ComplexMatrix {
        let mut system = self.all_coordinates(frequency);
        for place in self.prescribed() {
            for row in 0..self.dimension() {
                system[(row, place)] = Complex::ZERO;
            }
            system[(place, place)] = Complex::new(-1.0, 0.0);
        }
        for i in 0..self.dimension() {
            for j in 0..self.dimension() {
                system[(i, j)] *= scales.rows[i] * scales.columns[j];
            }
        }
        system
    }

    /// The scaled right-hand side of a harmonic load.
    pub(super) fn right_hand_side(
        &self,
        frequency: Complex,
        load: &HarmonicLoad,
        scales: &Scales,
    ) -> Vec<Complex> {
        let mut right = vec![Complex::ZERO; self.dimension()];
        for (j, torque) in load.pulley_torques.iter().enumerate() {
            right[self.pulley_index(j)] += torque;
        }
        for (arm, torque) in load.arm_torques.iter().enumerate() {
            right[self.arm_index(arm)] += torque;
        }
        if self.configuration.driver == DriverMotion::Prescribed {
            let driver = self.pulley_index(self.drive.driver);
            let matrix = self.all_coordinates(frequency);
            for (row, value) in right.iter_mut().enumerate() {
                *value -= matrix[(row, driver)] * load.driver_rotation;
            }
        }
        for (value, scale) in right.iter_mut().zip(&scales.rows) {
            *value *= scale;
        }
        right
    }

    /// The matrix with every coordinate free.
    fn all_coordinates(&self, frequency: Complex) -> ComplexMatrix {
        let mut matrix = ComplexMatrix::zeros(self.dimension(), self.dimension());
        for span in 0..self.continua.len() {
            self.add_span(&mut matrix, frequency, span);
        }
        self.add_pulleys(&mut matrix, frequency);
        self.add_accessories(&mut matrix, frequency);
        for (arm, (inertia, stiffness)) in self.arms.iter().enumerate() {
            let place = self.arm_index(arm);
            let damping = self.drive.tensioners[arm].damping;
            matrix[(place, place)] +=
                -frequency * frequency * *inertia + I * frequency * damping + *stiffness;
        }
        matrix
    }

    /// End conditions and stretch of a span, and what it does to the arms.
    fn add_span(&self, matrix: &mut ComplexMatrix, frequency: Complex, span: usize) {
        let continuum = &self.continua[span];
        let waves = continuum.waves(frequency);
        let (first, tension) = (self.wave_index(span), self.tension_index(span));
        let rates = &self.steady.kinematics.spans[span];
        // Every term that makes up the displacement, with the unknown it belongs to.
        let free = waves.free.iter().enumerate().map(|(k, term)| (first + k, term));
        let terms: Vec<_> = free
            .chain(waves.forced.iter().map(|term| (tension, term)))
            .collect();
        let ends = [0.0, continuum.length];
        for (end, x) in ends.into_iter().enumerate() {
            for (column, term) in &terms {
                matrix[(first + end, *column)] += term.derivative(x, 0);
                if continuum.order() == 4 {
                    matrix[(first + 2 + end, *column)] += term.derivative(x, 2);
                }
            }
            for (arm, rate) in rates.iter().enumerate() {
                let across = if end == 0 {
                    rate.across_start
                } else {
                    rate.across_end
                };
                matrix[(first + end, self.arm_index(arm))] -= across;
            }
        }
        // p/(k + iωc) = [u] + ∫ w*' w' dx, with the displacements of the rims along the span.
        let stiffness = self.springs[span] + I * frequency * self.dashpots[span];
        matrix[(tension, tension)] += stiffness.inv();
        for (column, term) in &terms {
            matrix[(tension, *column)] -= continuum.stretch(&waves, term);
        }
        let next = self.drive.next(span);
        matrix[(tension, self.pulley_index(span))] += self.drive.pulleys[span].radius;
        matrix[(tension, self.pulley_index(next))] -= self.drive.pulleys[next].radius;
        for (arm, rate) in rates.iter().enumerate() {
            let row = self.arm_index(arm);
            matrix[(tension, row)] -= rate.along();
            // The span on the arm, theory 04 (3.7).
            matrix[(row, tension)] += rate.along() + rate.across_end * continuum.slopes[1]
                - rate.across_start * continuum.slopes[0];
            for (column, term) in &terms {
                matrix[(row, *column)] += rate.across_end
                    * continuum.transverse_force(term, continuum.length, frequency)
                    - rate.across_start * continuum.transverse_force(term, 0.0, frequency);
            }
        }
    }

    /// Balances of the pulleys.
    fn add_pulleys(&self, matrix: &mut ComplexMatrix, frequency: Complex) {
        for (j, pulley) in self.drive.pulleys.iter().enumerate() {
            let row = self.pulley_index(j);
            let bearing = I * frequency * pulley.bearing_damping;
            matrix[(row, row)] += bearing - frequency * frequency * self.pulley_inertias[j];
            matrix[(row, self.tension_index(self.drive.span_before(j)))] += pulley.radius;
            matrix[(row, self.tension_index(j))] -= pulley.radius;
            if let Some((arm, factor)) = self.bearing_on_arm(j) {
                let arm = self.arm_index(arm);
                matrix[(row, arm)] += factor * bearing;
                matrix[(arm, row)] += factor * bearing;
                matrix[(arm, arm)] += bearing;
            }
        }
    }

    /// Balances of the accessories with a rotation of their own.
    fn add_accessories(&self, matrix: &mut ComplexMatrix, frequency: Complex) {
        for (place, (j, part)) in self.accessories.iter().enumerate() {
            let (pulley, accessory) = (self.pulley_index(*j), self.accessory_index(place));
            let link = part.stiffness + I * frequency * part.damping;
            matrix[(accessory, accessory)] += link - frequency * frequency * part.accessory_inertia;
            matrix[(pulley, pulley)] += link;
            matrix[(pulley, accessory)] -= link;
            matrix[(accessory, pulley)] -= link;
        }
    }
}

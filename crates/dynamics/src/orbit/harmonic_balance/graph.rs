//! A switching law as a piecewise-linear graph of one argument, read from its regimes.

use slackside_mechanics::{Piece, RegimeTable, Rest, Transition};

/// What the graph depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Argument {
    /// The displacement `u` of the port.
    Displacement,
    /// Its velocity `v`.
    Velocity,
}

/// The remainder `f − k u − c v` of a law beside its linear spring and damper, as a piecewise-linear graph of `x = u` or `x = v`,
/// continuous but for dry friction at rest: `constants[i] + slopes[i] x` between `levels[i−1]` and `levels[i]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Graph {
    /// What `x` is.
    pub argument: Argument,
    /// Where the pieces meet, rising; one fewer than pieces.
    pub levels: Vec<f64>,
    /// Jumps at the levels, zero where the graph is continuous.
    pub jumps: Vec<f64>,
    /// Values at `x = 0`, one per piece.
    pub constants: Vec<f64>,
    /// Slopes, one per piece.
    pub slopes: Vec<f64>,
    /// Index of the regime of each piece in the law's own table.
    pub regimes: Vec<usize>,
    /// Whether the element transmits on each piece.
    pub transmitting: Vec<bool>,
}

impl Graph {
    /// Reads a table beside the spring `k` and damper `c`. `None` if the law is not such a graph: its guards mix both
    /// arguments, its regimes overlap (hysteresis), its force jumps, it
    /// depends on both arguments, or it has an internal state.
    pub fn from_table(table: &RegimeTable, (spring, damper): (f64, f64)) -> Option<Self> {
        if table.internal {
            return None;
        }
        if !table.rests.is_empty() {
            return Self::from_friction(table, damper).filter(|_| spring == 0.0);
        }
        let guards = || table.regimes.iter().flat_map(|regime| &regime.guards);
        let argument = if guards().all(|guard| guard.velocity == 0.0) {
            Argument::Displacement
        } else if guards().all(|guard| guard.displacement == 0.0) {
            Argument::Velocity
        } else {
            return None;
        };
        let mut graph = Self {
            argument,
            levels: Vec::new(),
            jumps: Vec::new(),
            constants: Vec::new(),
            slopes: Vec::new(),
            regimes: Vec::new(),
            transmitting: Vec::new(),
        };
        let mut pieces = Vec::new();
        for (index, regime) in table.regimes.iter().enumerate() {
            let (mut low, mut high) = ((f64::NEG_INFINITY, None), (f64::INFINITY, None));
            for guard in &regime.guards {
                #[allow(
                    unreachable_patterns,
                    reason = "further transitions may be added to the law language"
                )]
                let next = match guard.transition {
                    Transition::To(next) => next,
                    _ => return None,
                };
                let factor = match argument {
                    Argument::Displacement => guard.displacement,
                    Argument::Velocity => guard.velocity,
                };
                let bound = -guard.constant / factor;
                if factor > 0.0 && bound > low.0 {
                    low = (bound, Some(next));
                } else if factor < 0.0 && bound < high.0 {
                    high = (bound, Some(next));
                } else if factor == 0.0 {
                    return None;
                }
            }
            pieces.push((low, high, index));
        }
        pieces.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
        if pieces.first()?.0.0 != f64::NEG_INFINITY || pieces.last()?.1.0 != f64::INFINITY {
            return None;
        }
        for pair in pieces.windows(2) {
            let (left, right) = (pair[0], pair[1]);
            let meet = (left.1.0 - right.0.0).abs() <= 1e-12 * left.1.0.abs();
            if !meet || left.1.1 != Some(right.2) || right.0.1 != Some(left.2) {
                return None;
            }
            graph.levels.push(right.0.0);
        }
        for &(_, _, index) in &pieces {
            let regime = &table.regimes[index];
            #[allow(
                unreachable_patterns,
                reason = "further pieces may be added to the law language"
            )]
            let (constant, by_displacement, by_velocity) = match regime.piece {
                Piece::Affine {
                    constant,
                    displacement,
                    velocity,
                    internal: _,
                } => (constant, displacement - spring, velocity - damper),
                _ => return None,
            };
            let (slope, other) = match argument {
                Argument::Displacement => (by_displacement, by_velocity),
                Argument::Velocity => (by_velocity, by_displacement),
            };
            if other != 0.0 {
                return None;
            }
            graph.constants.push(constant);
            graph.slopes.push(slope);
            graph.regimes.push(index);
            graph.transmitting.push(regime.transmitting);
        }
        graph.jumps = vec![0.0; graph.levels.len()];
        graph.is_continuous().then_some(graph)
    }

    /// Dry friction as a graph with a jump at rest. `None` if one of its rays is missing. Static limits beyond the rays' ends are
    /// not represented, nor is the force while the port sticks.
    fn from_friction(table: &RegimeTable, damper: f64) -> Option<Self> {
        let &[
            Rest {
                backward: Some(backward),
                forward: Some(forward),
                ..
            },
        ] = table.rests.as_slice()
        else {
            return None;
        };
        let ray = |regime: usize| match table.regimes[regime].piece {
            Piece::Affine {
                constant,
                displacement: 0.0,
                velocity,
                internal: _,
            } => Some((constant, velocity - damper)),
            _ => None,
        };
        let (left, right) = (ray(backward)?, ray(forward)?);
        Some(Self {
            argument: Argument::Velocity,
            levels: vec![0.0],
            jumps: vec![right.0 - left.0],
            constants: vec![left.0, right.0],
            slopes: vec![left.1, right.1],
            regimes: vec![backward, forward],
            transmitting: [backward, forward]
                .map(|r| table.regimes[r].transmitting)
                .to_vec(),
        })
    }

    /// Whether the remainder vanishes everywhere, so that the law is its own linearisation.
    pub fn is_zero(&self) -> bool {
        self.constants
            .iter()
            .chain(&self.slopes)
            .all(|&value| value == 0.0)
    }

    /// The piece that holds `x`.
    pub fn piece_at(&self, x: f64) -> usize {
        self.levels.iter().filter(|&&level| x > level).count()
    }

    fn is_continuous(&self) -> bool {
        self.levels.iter().enumerate().all(|(i, x)| {
            let (left, right) = (
                self.constants[i] + self.slopes[i] * x,
                self.constants[i + 1] + self.slopes[i + 1] * x,
            );
            let size = self.constants[i].abs()
                + self.constants[i + 1].abs()
                + (self.slopes[i] * x).abs()
                + (self.slopes[i + 1] * x).abs();
            (left - right).abs() <= 1e-12 * size
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use slackside_mechanics::laws::{
        Isolator, asymmetric_coulomb, backlash, one_way, one_way_damper, wrap_spring,
    };
    use slackside_mechanics::{Guard, Law, Regime};

    #[test]
    fn a_clutch_removes_its_own_spring_when_open() {
        let clutch = wrap_spring(24.0);
        let graph = Graph::from_table(&clutch.regimes().unwrap(), clutch.linearized()).unwrap();
        assert_eq!(graph.argument, Argument::Displacement);
        assert_eq!(graph.levels, [0.0]);
        assert_eq!(graph.slopes, [-24.0, 0.0]);
        assert_eq!(graph.transmitting, [false, true]);
        assert!(!graph.is_zero());
    }

    #[test]
    fn remainder_and_linear_part_make_the_law() {
        for law in [backlash(3.0, 0.2), one_way_damper(0.7)] {
            let (k, c) = law.linearized();
            let graph = Graph::from_table(&law.regimes().unwrap(), (k, c)).unwrap();
            for i in 0..30 {
                let (u, v) = (-1.01 + 0.07 * i as f64, 0.93 - 0.07 * i as f64);
                let x = if graph.argument == Argument::Velocity {
                    v
                } else {
                    u
                };
                let piece = graph.piece_at(x);
                let force = graph.constants[piece] + graph.slopes[piece] * x + k * u + c * v;
                assert!((force - law.response(u, v).force).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_linear_law_leaves_no_remainder() {
        let law = Isolator {
            stiffness: 2.0,
            damping: 0.1,
        };
        assert!(
            Graph::from_table(&law.regimes().unwrap(), law.linearized())
                .unwrap()
                .is_zero()
        );
    }

    #[test]
    fn dry_friction_jumps_at_rest_and_a_clutch_is_no_graph() {
        let law = asymmetric_coulomb(1.0, 2.0, 1.3);
        let graph = Graph::from_table(&law.regimes().unwrap(), (0.0, 0.5)).unwrap();
        assert_eq!((graph.levels[0], graph.jumps[0]), (0.0, 3.0));
        assert_eq!(
            (graph.constants, graph.slopes),
            (vec![-1.0, 2.0], vec![-0.5, -0.5])
        );
        assert!(Graph::from_table(&one_way().regimes().unwrap(), (0.0, 0.0)).is_none());
    }

    #[test]
    fn what_is_not_a_continuous_graph_is_refused() {
        let regime = |factor: f64, constant: f64, force: f64, to: usize| {
            let guard = Guard::on_displacement(factor, constant, Transition::To(to));
            Regime::new("test", true, Piece::constant(force), vec![guard])
        };
        let jump = RegimeTable::of_function(vec![regime(-1.0, 0.0, -1.0, 1), regime(1.0, 0.0, 1.0, 0)]);
        assert!(Graph::from_table(&jump, (0.0, 0.0)).is_none());
        let overlap = RegimeTable::of_function(vec![regime(-1.0, 0.5, 1.0, 1), regime(1.0, 0.5, 1.0, 0)]);
        assert!(Graph::from_table(&overlap, (0.0, 0.0)).is_none());
    }
}

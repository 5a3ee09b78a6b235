//! The regime in which an element starts.

use super::regime_factory::RegimeFactory;
use slackside_mechanics::{Piece, Regime, Rest};

/// How an element starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StartingRegime {
    pub regime: usize,
    /// The rest at which it is, if its port does not move.
    pub rest: Option<usize>,
    /// Whether the port moves in a direction that the law does not allow.
    pub refused: bool,
}

impl RegimeFactory {
    /// The regime in which an element starts; for one at rest a provisional one.
    pub fn starting_regime(&self, element: usize, x: &[f64]) -> StartingRegime {
        let table = &self.tables[element];
        let (u, v, zeta) = self.port_motion(element, x);
        let of = |regime: usize| StartingRegime {
            regime,
            rest: None,
            refused: false,
        };
        let least = |regime: &Regime| {
            let values = regime
                .guards
                .iter()
                .map(|g| g.displacement * u + g.velocity * v + g.internal * zeta + g.constant);
            values.fold(f64::INFINITY, f64::min)
        };
        if table.rests.is_empty() {
            // A regime that transmits and whose guards are all positive holds; otherwise the one whose worst guard is best:
            // the one that holds, or a neighbour on a surface.
            let regimes = || table.regimes.iter().enumerate();
            let best = regimes()
                .find(|(_, regime)| regime.transmitting && least(regime) > 0.0)
                .or_else(|| regimes().max_by(|a, b| least(a.1).total_cmp(&least(b.1))));
            return of(best.map_or(0, |(regime, _)| regime));
        }
        // Of several rests (segments of a measured loop) the one whose bounds of the displacement hold.
        let inside = |rest: &Rest| {
            let bounds = rest.candidates().flat_map(|regime| &table.regimes[regime].guards);
            bounds
                .filter(|g| g.displacement != 0.0 && g.force == 0.0)
                .all(|g| g.displacement * u + g.constant >= 0.0)
        };
        let number = table.rests.iter().position(inside).unwrap_or(0);
        let rest = &table.rests[number];
        let stop = rest.stick.and_then(|stick| match table.regimes[stick].piece {
            Piece::Stick { position } => position,
            _ => None,
        });
        if let Some(position) = stop {
            let terms = self.ports[element].iter().zip(x).map(|(b, q)| (b * q).abs());
            let size = position.abs() + terms.sum::<f64>();
            if (u - position).abs() > 1e-12 * size {
                return of(rest.backward.unwrap_or(0));
            }
        }
        if let (true, Some(wound)) = (table.internal && zeta > 0.0, rest.forward) {
            return of(wound);
        }
        if self.is_at_rest(element, x) {
            return StartingRegime {
                rest: Some(number),
                ..of(rest.stick.or(rest.backward).unwrap_or(0))
            };
        }
        let moving = if v < 0.0 { rest.backward } else { rest.forward };
        match (moving, stop) {
            (Some(regime), _) => of(regime),
            // A port that moves into its stop is about to hit it.
            (None, Some(_)) => of(rest.backward.unwrap_or(0)),
            (None, None) => StartingRegime {
                rest: Some(number),
                refused: true,
                ..of(rest.stick.unwrap_or(0))
            },
        }
    }

    /// Puts a port that lies on its stop exactly there, with the least motion of the others.
    pub fn place_on_stop(&self, element: usize, rest: usize, z: &mut [f64]) {
        let table = &self.tables[element];
        let stick = table.rests[rest].stick.map(|stick| table.regimes[stick].piece);
        if let Some(Piece::Stick {
            position: Some(position),
        }) = stick
        {
            let (u, _, _) = self.port_motion(element, z);
            let share = (position - u) / self.mobility[(element, element)];
            for (q, response) in z.iter_mut().zip(&self.port_acceleration[element]) {
                *q += share * response;
            }
        }
    }
}

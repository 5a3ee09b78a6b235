//! The monodromy matrix of a piecewise-linear motion: the product of `exp(A Δt)` over its regimes. The force of a graph is
//! continuous, so that the saltation matrix at every event is the identity (theory 02 §2).

use super::super::{HarmonicBalanceError, HarmonicOrbit};
use super::StateMatrices;
use slackside_linalg::{Matrix, exponential};
use slackside_mechanics::{Piece, RegimeTable};
use std::f64::consts::TAU;

/// The monodromy matrix over one period of the motion from its switching angles.
pub fn monodromy(orbit: &HarmonicOrbit) -> Result<Matrix, HarmonicBalanceError> {
    let mut tables: Vec<RegimeTable> = Vec::new();
    let mut regimes = Vec::new();
    for (element, start) in orbit.system.elements.iter().zip(&orbit.regimes_at_start) {
        match (element.law.regimes(), start) {
            (Some(table), Some(start)) => {
                tables.push(table);
                regimes.push(*start);
            }
            _ => {
                return Err(HarmonicBalanceError::NotPiecewiseLinear {
                    element: element.name.clone(),
                });
            }
        }
    }
    let matrices = StateMatrices::new(&orbit.system, orbit.frequency)?;
    let mut result = Matrix::identity(2 * orbit.system.order());
    let mut phase = 0.0;
    let mut advance = |regimes: &[usize], to: f64| -> Result<(), HarmonicBalanceError> {
        if to > phase {
            let tangents = tables
                .iter()
                .zip(regimes)
                .map(|(table, &regime)| tangents(table, regime));
            let matrix = matrices.with_tangents(tangents);
            result = exponential(&matrix.scaled((to - phase) / orbit.frequency))?.product(&result);
            phase = to;
        }
        Ok(())
    };
    for event in &orbit.events {
        advance(&regimes, event.phase)?;
        regimes[event.element] = event.to;
    }
    advance(&regimes, TAU * orbit.subharmonic as f64)?;
    Ok(result)
}

fn tangents(table: &RegimeTable, regime: usize) -> (f64, f64) {
    match table.regimes[regime].piece {
        Piece::Affine {
            displacement,
            velocity,
            ..
        } => (displacement, velocity),
        // Only affine pieces have been read as a graph, and only graphs have a regime at the start.
        #[allow(
            unreachable_patterns,
            reason = "further pieces may be added to the law language"
        )]
        _ => (0.0, 0.0),
    }
}

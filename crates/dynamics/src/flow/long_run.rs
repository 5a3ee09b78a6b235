//! Many periods at a time, looking far ahead within each regime.

use super::FlowError;
use super::event::Crossing;
use super::exact::{EVENT_BUDGET, Entry, ExactFlow, FlowState, first_event};
use super::generator::Layout;
use super::measure::{Record, Request, measure_row};
use super::scan::{CELLS, CELLS_PER_STEP, Scan};
use super::settled::{DecayingRegime, ForcedMotion};
use super::step_map::StepMap;
use super::visitor::Visitor;
use crate::orbit::MeasureSummary;
use slackside_linalg::Complex;
use slackside_mechanics::Output;
use std::f64::consts::TAU;

/// Where a long run stands: whole periods done, and time since.
struct Clock {
    period: f64,
    periods: usize,
    done: usize,
    time: f64,
}

impl Clock {
    fn remaining(&self) -> f64 {
        (self.periods - self.done) as f64 * self.period - self.time
    }

    fn advance(&mut self, duration: f64) {
        self.time += duration;
        while self.time >= self.period && self.done + 1 < self.periods {
            self.time -= self.period;
            self.done += 1;
        }
    }
}

/// How far the motion goes on without an event: whole cells of the scan, then a share of a step.
struct Outlook {
    cells: usize,
    share: f64,
    /// Number of the guard that is crossed there.
    crossed: Option<usize>,
}

/// Looks ahead from `z`, at most over `remaining` time, and leaves in `z` the state at the last whole cell.
fn look(
    map: &StepMap,
    scan: &mut Scan,
    layout: &Layout,
    z: &mut [f64],
    entry: &Entry,
    clock: &Clock,
    remaining: f64,
) -> Outlook {
    let nx = layout.state();
    // The step at which the regime begins is always tested in full: a guard may vanish at its start.
    let limit = (remaining / map.step).min(1.0);
    let (share, crossed) = first_event(map, z, entry, limit);
    if crossed.is_some() || limit < 1.0 {
        return Outlook {
            cells: 0,
            share,
            crossed,
        };
    }
    scan.look_ahead(z);
    let mut cells = CELLS_PER_STEP;
    while cells < CELLS {
        let left = remaining - cells as f64 * scan.cell;
        if left > scan.cell && scan.is_clear(cells, nx) {
            cells += 1;
            continue;
        }
        z[..nx].copy_from_slice(scan.state(cells - 1, nx));
        layout.set_phase(
            z,
            (clock.time + cells as f64 * scan.cell) * map.generator.frequency,
        );
        let limit = (left / map.step).clamp(0.0, 1.0);
        let (share, crossed) = first_event(map, z, &Entry::default(), limit);
        if crossed.is_some() || limit < 1.0 || cells + CELLS_PER_STEP > CELLS {
            return Outlook {
                cells,
                share,
                crossed,
            };
        }
        cells += CELLS_PER_STEP;
    }
    z[..nx].copy_from_slice(scan.state(CELLS - 1, nx));
    Outlook {
        cells: CELLS,
        share: 0.0,
        crossed: None,
    }
}

/// A motion that provably stays in its regime for ever.
struct Settled<'a> {
    regime: &'a DecayingRegime,
    forced: &'a ForcedMotion,
    orders: &'a [usize],
    amplitudes: Vec<Complex>,
}

impl ExactFlow {
    /// Moves a state through whole periods of the load, from phase zero. The visitor sees events only.
    pub(super) fn long_run<V: Visitor>(
        &mut self,
        state: &mut FlowState,
        periods: usize,
        visitor: &mut V,
    ) -> Result<(), FlowError> {
        let nx = state.x.len();
        let mut clock = Clock {
            period: TAU / self.frequency,
            periods,
            done: 0,
            time: 0.0,
        };
        let mut z = std::mem::take(&mut self.z);
        z[..nx].copy_from_slice(&state.x);
        self.factory.layout.set_phase(&mut z, 0.0);
        let outcome = self.cover(&mut z, state, &mut clock, visitor);
        state.x.copy_from_slice(&z[..nx]);
        self.z = z;
        outcome?;
        if state.x.iter().all(|value| value.abs() < 1e150) {
            Ok(())
        } else {
            Err(FlowError::Unbounded { periods: clock.done })
        }
    }

    fn cover<V: Visitor>(
        &mut self,
        z: &mut [f64],
        state: &mut FlowState,
        clock: &mut Clock,
        visitor: &mut V,
    ) -> Result<(), FlowError> {
        let mut position = self.position(state.joint)?;
        let mut budget = EVENT_BUDGET * clock.periods;
        loop {
            self.prepare_scan(position);
            let (maps, scans) = (&self.maps, &mut self.scans);
            let (map, Some(scan)) = (&maps[position], &mut scans[position]) else {
                return Ok(());
            };
            let remaining = clock.remaining();
            if remaining <= 4.0 * f64::EPSILON * clock.period {
                return Ok(());
            }
            let Outlook {
                cells,
                share,
                crossed,
            } = look(map, scan, &self.factory.layout, z, &state.entry, clock, remaining);
            if share > 0.0 {
                map.advance_partial(z, share, &mut self.work);
            }
            clock.advance(cells as f64 * scan.cell + share * map.step);
            self.factory.layout.set_phase(z, clock.time * self.frequency);
            let Some(number) = crossed else {
                state.entry.clear();
                if cells == CELLS && self.jump_to_end(position, z, clock) {
                    return Ok(());
                }
                continue;
            };
            let crossing = Crossing {
                position,
                number,
                time: clock.done as f64 * clock.period + clock.time,
            };
            position = self.pass(&crossing, z, state, &mut [], visitor)?;
            budget -= 1;
            if budget == 0 {
                return Err(FlowError::EventBudget {
                    budget: EVENT_BUDGET,
                    phase: clock.time * self.frequency,
                });
            }
        }
    }

    /// The closed form of the motion that is at `x` now at phase `phase`, if it provably stays in its regime for ever.
    fn settled(&mut self, position: usize, x: &[f64], phase: f64) -> Option<Settled<'_>> {
        if self.decaying.len() < self.maps.len() {
            self.decaying.resize(self.maps.len(), None);
        }
        let map = &self.maps[position];
        let (regime, forced) =
            self.decaying[position].get_or_insert_with(|| (DecayingRegime::new(map), None));
        let regime = regime.as_ref()?;
        if forced
            .as_ref()
            .is_none_or(|forced| forced.frequency != self.frequency)
        {
            *forced = regime.forced(map).ok();
        }
        let forced = forced.as_ref()?;
        let orders = &self.factory.layout.orders;
        let amplitudes = regime.free_amplitudes(forced, orders, x, phase)?;
        Some(Settled {
            regime,
            forced,
            orders,
            amplitudes,
        })
    }

    /// If the motion provably stays in its regime for ever, moves the state to the end of the run in closed form.
    fn jump_to_end(&mut self, position: usize, z: &mut [f64], clock: &Clock) -> bool {
        let nx = self.factory.layout.state();
        let phase = clock.time * self.frequency;
        let Some(motion) = self.settled(position, &z[..nx], phase) else {
            return false;
        };
        let state = motion.regime.state_after(
            motion.forced,
            motion.orders,
            &motion.amplitudes,
            clock.remaining(),
            0.0,
        );
        z[..nx].copy_from_slice(&state);
        true
    }

    /// The record of a motion from phase zero in closed form, if it provably stays in its regime for ever. Moves the state
    /// to the end. Extremes are not known in closed form.
    pub(super) fn settled_record(
        &mut self,
        state: &mut FlowState,
        periods: usize,
        outputs: &[Output],
        request: &Request,
    ) -> Result<Option<Record>, FlowError> {
        let position = self.position(state.joint)?;
        let factory = self.factory.clone();
        let period = TAU / self.frequency;
        let generator = &self.maps[position].generator;
        let rows: Vec<Vec<f64>> = outputs
            .iter()
            .map(|output| measure_row(generator, output))
            .collect();
        let Some(motion) = self.settled(position, &state.x, 0.0) else {
            return Ok(None);
        };
        let time = periods as f64 * period;
        let mut record = Record {
            measures: Vec::with_capacity(outputs.len()),
            events: Vec::new(),
            fractions: Vec::new(),
            samples: Vec::with_capacity(outputs.len()),
            ..Record::default()
        };
        for row in &rows {
            let sum = motion
                .regime
                .measure(motion.forced, motion.orders, &motion.amplitudes, row);
            let (mean, rms) = sum.mean_and_rms(time);
            let fundamental = TAU / time;
            let orders = if request.harmonics > 0 {
                request.harmonics + 1
            } else {
                0
            };
            let harmonics = (0..orders).map(|k| sum.harmonic(k, fundamental, time)).collect();
            let range = (f64::NEG_INFINITY, f64::INFINITY);
            record.measures.push(MeasureSummary {
                mean,
                rms,
                max: range.0,
                min: range.1,
                harmonics,
            });
            let mut samples = Vec::with_capacity(request.samples * periods);
            for done in 0..periods {
                let interval = period / request.samples as f64;
                sum.sample(done as f64 * period, interval, request.samples, &mut samples);
            }
            record.samples.push(samples);
        }
        for (element, table) in factory.tables.iter().enumerate() {
            let holds = factory.regime_of(state.joint, element);
            record.fractions.push(
                (0..table.regimes.len())
                    .map(|r| f64::from(u8::from(r == holds)))
                    .collect(),
            );
        }
        let end = motion
            .regime
            .state_after(motion.forced, motion.orders, &motion.amplitudes, time, 0.0);
        record.drift = (0..factory.layout.coordinates)
            .map(|i| end[i] - state.x[i])
            .collect();
        state.x = end;
        Ok(Some(record))
    }

    /// Makes the tables of a regime for the current frequency, if they are not there.
    fn prepare_scan(&mut self, position: usize) {
        if self.scans.len() < self.maps.len() {
            self.scans.resize(self.maps.len(), None);
        }
        if self.scans[position]
            .as_ref()
            .is_none_or(|scan| scan.frequency != self.frequency)
        {
            self.scans[position] = Some(Scan::new(&self.maps[position], &mut self.work));
        }
    }
}

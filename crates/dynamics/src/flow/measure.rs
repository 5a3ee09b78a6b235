//! Statistics of measures along the exact flow: integrals and extremes per piece, to rounding (theory 02 §9.2).

use super::account::{Account, Bookkeeper};
use super::generator::Generator;
use super::regime_factory::RegimeFactory;
use super::step_map::{StepMap, Work};
use super::visitor::{Event, Piece, Visitor};
use crate::orbit::{EventRecord, MeasureSummary};
use slackside_linalg::Complex;
use slackside_mechanics::Output;
use slackside_numerics::polynomial::{Coefficients, TERMS, extend_range, values};
use slackside_numerics::quadrature::{NODES, gauss_legendre};
use std::f64::consts::TAU;
use std::sync::Arc;

/// What to compute of each measure over a stretch of motion.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Request {
    /// Number of harmonics of the whole stretch.
    pub harmonics: usize,
    /// Whether extremes are wanted (they cost more than integrals).
    pub extremes: bool,
    /// Equally spaced samples per period of the load, from phase zero on; zero for none.
    pub samples: usize,
    /// Whether the energy account and the reversals of elements are wanted.
    pub account: bool,
}

/// A stretch of motion over whole periods of the load.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// One summary per output, in order.
    pub measures: Vec<MeasureSummary>,
    /// Events, phases counted from the start of the stretch.
    pub events: Vec<EventRecord>,
    /// Fraction of time per element and regime; empty for smooth systems.
    pub fractions: Vec<Vec<f64>>,
    /// Samples per output, as many as requested per period times the periods.
    pub samples: Vec<Vec<f64>>,
    /// Change of every coordinate over the stretch: zero for a motion that repeats, but for the angle by which an accessory
    /// overruns.
    pub drift: Vec<f64>,
    /// The energy account, if requested of an exact flow.
    pub account: Option<Account>,
}

/// Measures as rows on the augmented state, per regime, made when first needed.
#[derive(Debug, Clone)]
struct MeasureRows {
    factory: Arc<RegimeFactory>,
    outputs: Vec<Output>,
    /// By position of the regime in the flow's store.
    rows: Vec<Option<Vec<Vec<f64>>>>,
}

impl MeasureRows {
    pub fn new(factory: Arc<RegimeFactory>, outputs: Vec<Output>) -> Self {
        Self {
            factory,
            outputs,
            rows: Vec::new(),
        }
    }

    /// The rows in the joint regime of `map`, which stands at `position` in the flow's store.
    pub fn at(&mut self, position: usize, map: &StepMap) -> &[Vec<f64>] {
        if self.rows.len() <= position {
            self.rows.resize(position + 1, None);
        }
        let outputs = &self.outputs;
        self.rows[position].get_or_insert_with(|| {
            outputs
                .iter()
                .map(|output| measure_row(&map.generator, output))
                .collect()
        })
    }
}

pub(super) fn measure_row(generator: &Generator, output: &Output) -> Vec<f64> {
    let layout = &generator.layout;
    let (n, nx) = (layout.coordinates, layout.state());
    let mut row = vec![0.0; layout.augmented()];
    for &(i, factor) in &output.displacement {
        row[i] += factor;
    }
    for &(i, factor) in &output.velocity {
        row[n + i] += factor;
    }
    row[nx] += output.constant;
    for &(element, factor) in &output.force {
        for (sum, value) in row.iter_mut().zip(&generator.forces[element]) {
            *sum += factor * value;
        }
    }
    for &(order, cosine, sine) in &output.harmonics {
        if let Some(k) = layout.orders.iter().position(|&o| o == order) {
            row[nx + 1 + 2 * k] += cosine;
            row[nx + 2 + 2 * k] += sine;
        }
    }
    row
}

/// Sums of one measure over the pieces seen.
#[derive(Debug, Clone)]
struct Sums {
    /// First value seen: subtracted before squaring, against cancellation.
    reference: f64,
    integral: f64,
    square: f64,
    range: (f64, f64),
    harmonics: Vec<Complex>,
}

/// Accumulates summaries, events and the time spent in each regime over whole periods of a motion.
#[derive(Debug)]
pub(crate) struct SummaryVisitor {
    rows: MeasureRows,
    request: Request,
    work: Work,
    frequency: f64,
    /// Periods of the load after which the motion repeats.
    periods: usize,
    /// Phase at the start of the current period of the load.
    pub offset: f64,
    sums: Vec<Sums>,
    pub events: Vec<EventRecord>,
    /// Time per element and regime.
    durations: Vec<Vec<f64>>,
    polynomials: Vec<Coefficients>,
    samples: Vec<Vec<f64>>,
    bookkeeper: Option<Bookkeeper>,
}

impl SummaryVisitor {
    pub fn new(
        factory: &Arc<RegimeFactory>,
        outputs: Vec<Output>,
        request: Request,
        frequency: f64,
        periods: usize,
    ) -> Self {
        let sums = Sums {
            reference: f64::NAN,
            integral: 0.0,
            square: 0.0,
            range: (f64::INFINITY, f64::NEG_INFINITY),
            harmonics: vec![
                Complex::ZERO;
                if request.harmonics > 0 {
                    request.harmonics + 1
                } else {
                    0
                }
            ],
        };
        Self {
            sums: vec![sums; outputs.len()],
            polynomials: vec![[0.0; TERMS]; outputs.len()],
            samples: vec![Vec::with_capacity(request.samples * periods); outputs.len()],
            rows: MeasureRows::new(factory.clone(), outputs),
            bookkeeper: request.account.then(|| Bookkeeper::new(factory)),
            request,
            work: Work::new(factory.layout.state(), factory.layout.augmented()),
            frequency,
            periods,
            offset: 0.0,
            events: Vec::new(),
            durations: factory
                .tables
                .iter()
                .map(|table| vec![0.0; table.regimes.len()])
                .collect(),
        }
    }

    /// The record over `periods` periods of the load.
    pub fn finish(self) -> Record {
        let total = self.periods as f64 * TAU / self.frequency;
        let measures = self
            .sums
            .into_iter()
            .map(|sums| {
                let shift = sums.integral / total;
                let harmonics = sums
                    .harmonics
                    .iter()
                    .enumerate()
                    .map(|(k, sum)| {
                        if k == 0 {
                            Complex::from(sums.reference + shift)
                        } else {
                            2.0 * sum / total
                        }
                    })
                    .collect();
                MeasureSummary {
                    mean: sums.reference + shift,
                    rms: (sums.square / total - shift * shift).max(0.0).sqrt(),
                    max: sums.range.1,
                    min: sums.range.0,
                    harmonics,
                }
            })
            .collect();
        let fractions = self
            .durations
            .iter()
            .map(|times| times.iter().map(|time| time / total).collect())
            .collect();
        Record {
            measures,
            events: self.events,
            fractions,
            samples: self.samples,
            drift: Vec::new(),
            account: self.bookkeeper.map(Bookkeeper::finish),
        }
    }
}

impl SummaryVisitor {
    /// Adds the piece to means, squares and harmonics.
    fn integrate(&mut self, piece: &Piece<'_>) {
        let rule = gauss_legendre();
        let per_period = self.frequency / self.periods as f64;
        // Harmonics turn faster than the motion itself: shorter panels keep the quadrature at rounding.
        let turn = self.request.harmonics as f64 * per_period * piece.duration;
        let panels = (turn / 3.0).ceil().max(1.0);
        for panel in 0..panels as usize {
            let shares = rule.nodes.map(|node| (panel as f64 + node) / panels);
            let turns = shares.map(|share| {
                if self.request.harmonics == 0 {
                    return Complex::ONE;
                }
                let time = piece.time + share * piece.duration;
                Complex::cis(-(self.offset / self.periods as f64 + per_period * time))
            });
            let places = shares.map(|share| share * piece.share);
            for (sums, polynomial) in self.sums.iter_mut().zip(&self.polynomials) {
                let values = values(polynomial, &places);
                for node in 0..NODES {
                    let weight = rule.weights[node] * piece.duration / panels;
                    let y = values[node] - sums.reference;
                    sums.integral += weight * y;
                    sums.square += weight * y * y;
                    let mut power = Complex::from(weight * y);
                    for sum in &mut sums.harmonics {
                        *sum += power;
                        power *= turns[node];
                    }
                }
            }
        }
    }

    /// Takes the samples that fall into `[start, end)` of the piece.
    fn sample(&mut self, piece: &Piece<'_>) {
        if self.request.samples == 0 {
            return;
        }
        let interval = TAU / self.frequency / self.request.samples as f64;
        let done = (self.offset / TAU).round() as usize * self.request.samples;
        let mut taken = self.samples.first().map_or(0, Vec::len) - done;
        while taken < self.request.samples && taken as f64 * interval - piece.time < piece.duration {
            // Several samples at once, of which those beyond the piece are dropped.
            let mut places = [0.0; BATCH];
            let mut count = 0;
            for place in &mut places {
                let ahead = (taken + count) as f64 * interval - piece.time;
                if taken + count >= self.request.samples || ahead >= piece.duration {
                    break;
                }
                *place = (ahead / piece.map.step).max(0.0);
                count += 1;
            }
            for (samples, polynomial) in self.samples.iter_mut().zip(&self.polynomials) {
                samples.extend_from_slice(&values(polynomial, &places)[..count]);
            }
            taken += count;
        }
    }
}

/// Samples evaluated at once.
const BATCH: usize = 8;

impl Visitor for SummaryVisitor {
    const WANTS_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece<'_>) {
        for (element, times) in self.durations.iter_mut().enumerate() {
            times[self.rows.factory.regime_of(piece.map.joint, element)] += piece.duration;
        }
        if let Some(bookkeeper) = &mut self.bookkeeper {
            bookkeeper.piece(piece, &mut self.work);
        }
        if self.sums.is_empty() {
            return;
        }
        let polynomial = piece.map.polynomial(piece.z, &mut self.work);
        let rows = self.rows.at(piece.position, piece.map);
        for ((measure, sums), row) in self.polynomials.iter_mut().zip(&mut self.sums).zip(rows) {
            *measure = piece.map.measure(row, piece.z, polynomial);
            if sums.reference.is_nan() {
                sums.reference = measure[0];
            }
        }
        self.integrate(piece);
        self.sample(piece);
        if self.request.extremes {
            for (sums, polynomial) in self.sums.iter_mut().zip(&self.polynomials) {
                sums.range = extend_range(polynomial, piece.share, sums.range);
            }
        }
    }

    fn impact(&mut self, element: usize, energy: f64) {
        if let Some(bookkeeper) = &mut self.bookkeeper {
            bookkeeper.impact(element, energy);
        }
    }

    fn event(&mut self, event: &Event) {
        if let Some(bookkeeper) = &mut self.bookkeeper {
            bookkeeper.event(event);
        }
        self.events.push(EventRecord {
            phase: self.offset + event.time * self.frequency,
            element: event.element,
            from: event.from,
            to: event.to,
        });
    }
}

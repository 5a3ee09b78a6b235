//! Steady states by amplitude: for each amplitude the frequency relation has up to two roots (theory 02 (C17), (C20)).
//!
//! Over the amplitude the roots form arcs; an arc ends where the two roots meet, at the top of the resonance, or at the
//! bounds of the search. Folds are zeros of the slow flow's determinant along an arc, and between folds the frequency is
//! monotone, so that no steady state at a given frequency is missed.

use super::slow_flow::AtAmplitude;
use super::{Order, PrimaryResonance, SteadyState};

/// Amplitudes at which roots are looked at, evenly in their logarithm.
const NODES: usize = 400;
/// Further amplitudes on either side of the onset of separation, where the frequency bends sharply, and at ends of arcs.
const GRADED: usize = 48;
/// Smallest amplitude, relative to that of onset and to the static response.
const SMALLEST: f64 = 1e-3;
/// Largest amplitude of the second order, relative to the largest of the first.
const BEYOND: f64 = 3.0;
/// Relative distance from the amplitude of onset within which a pair of folds is an artefact.
const ARTEFACT: f64 = 5e-3;
/// Halvings of a bracket.
const HALVINGS: usize = 80;

/// Which of the two roots of the frequency relation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Root {
    Lower,
    Upper,
}

/// Connected steady states of one root, by rising amplitude.
struct Arc {
    root: Root,
    /// Amplitude and frequency.
    nodes: Vec<(f64, f64)>,
}

impl PrimaryResonance {
    /// The frequencies at which steady states have the amplitude, lower and upper; `None` where there is none.
    pub fn frequencies(&self, order: Order, amplitude: f64) -> [Option<f64>; 2] {
        self.frequencies_of(order, amplitude, &self.at_amplitude(order, amplitude))
    }

    fn frequencies_of(&self, order: Order, a: f64, at: &AtAmplitude) -> [Option<f64>; 2] {
        let (w, zeta) = (self.frequency(), self.damping_ratio());
        let positive = |value: f64| (value > 0.0 && value.is_finite()).then_some(value);
        match order {
            Order::First => {
                let square = (at.cosine_load / (2.0 * w * a)).powi(2) - (zeta * w).powi(2);
                if square < 0.0 {
                    return [None; 2];
                }
                let backbone = w - at.shift / (2.0 * w * a);
                [
                    positive(backbone - square.sqrt()),
                    positive(backbone + square.sqrt()),
                ]
            }
            Order::Second => {
                // ((A_0 − aX)/F_c)² + (2ζ_nω_n a/F_s)² X = 1 for X = Ω².
                let restoring = w * w * a - at.shift;
                let loss = (2.0 * zeta * w * a * at.cosine_load / at.sine_load).powi(2);
                let half = restoring * a - 0.5 * loss;
                let product = restoring * restoring - at.cosine_load * at.cosine_load;
                let square = half * half - a * a * product;
                if square.is_nan() || square < 0.0 {
                    return [None; 2];
                }
                let root = square.sqrt();
                // The quotient form of the smaller root does not cancel.
                let upper = (half + root) / (a * a);
                let lower = if half + root > 0.0 {
                    product / (half + root)
                } else {
                    (half - root) / (a * a)
                };
                [lower, upper].map(|x| positive(x).map(f64::sqrt))
            }
        }
    }

    fn root(&self, order: Order, root: Root, amplitude: f64) -> Option<f64> {
        let [lower, upper] = self.frequencies(order, amplitude);
        match root {
            Root::Lower => lower,
            Root::Upper => upper,
        }
    }

    /// The steady state of an amplitude at a frequency that the frequency relation gives for it, with its phase.
    pub fn steady_state(&self, order: Order, amplitude: f64, frequency: f64) -> SteadyState {
        let at = self.at_amplitude(order, amplitude);
        let (w, zeta) = (self.frequency(), self.damping_ratio());
        let (sine, cosine) = match order {
            Order::First => (
                2.0 * zeta * w * w * amplitude / at.sine_load,
                -(2.0 * w * amplitude * (frequency - w) + at.shift) / at.cosine_load,
            ),
            Order::Second => (
                2.0 * zeta * w * frequency * amplitude / at.sine_load,
                ((w * w - frequency * frequency) * amplitude - at.shift) / at.cosine_load,
            ),
        };
        SteadyState {
            frequency,
            amplitude,
            phase: sine.atan2(cosine),
        }
    }

    /// All steady states at a frequency, by rising amplitude; at second order up to three times the largest amplitude of the
    /// first.
    pub fn states_at(&self, order: Order, frequency: f64) -> Vec<SteadyState> {
        let mut found: Vec<f64> = Vec::new();
        for mut arc in self.arcs(order) {
            let folds = self.folds_on(order, &arc);
            arc.nodes
                .extend(folds.iter().map(|fold| (fold.amplitude, fold.frequency)));
            arc.nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
            for pair in arc.nodes.windows(2) {
                let (left, right) = (pair[0].1 - frequency, pair[1].1 - frequency);
                if left == 0.0 {
                    found.push(pair[0].0);
                } else if left * right < 0.0 {
                    let value = |a: f64| Some(self.root(order, arc.root, a)? - frequency);
                    found.push(bisect(pair[0].0, pair[1].0, left > 0.0, &value));
                }
            }
        }
        found.sort_by(f64::total_cmp);
        found.dedup_by(|a, b| (*a - *b).abs() <= 1e-12 * *b);
        let states = found.into_iter();
        states
            .map(|amplitude| self.steady_state(order, amplitude, frequency))
            .collect()
    }

    /// The folds of the response over frequency, by falling frequency.
    ///
    /// At second order the coefficients `e_k` start like a square root at the onset of separation, which may turn the curve
    /// back over a ten-thousandth of the amplitude. That pair of folds is an artefact of the expansion, the image of a
    /// grazing motion, and is left out.
    pub fn folds(&self, order: Order) -> Vec<SteadyState> {
        let arcs = self.arcs(order);
        let mut folds: Vec<SteadyState> = Vec::new();
        for arc in &arcs {
            let found = self.folds_on(order, arc);
            let mut i = 0;
            while i < found.len() {
                let pair = found.get(i..i + 2);
                if pair.is_some_and(|pair| pair.iter().all(|fold| self.is_at_onset(fold.amplitude))) {
                    i += 2;
                } else {
                    folds.push(found[i]);
                    i += 1;
                }
            }
        }
        folds.sort_by(|a, b| b.frequency.total_cmp(&a.frequency));
        folds
    }

    /// The steady states at the onset of separation, by rising frequency.
    pub fn onset(&self, order: Order) -> Vec<SteadyState> {
        let amplitude = self.onset_amplitude();
        let frequencies = self.frequencies(order, amplitude).into_iter().flatten();
        frequencies
            .map(|frequency| self.steady_state(order, amplitude, frequency))
            .collect()
    }

    /// Whether an amplitude is so close to the onset of separation that two folds there are an artefact.
    pub fn is_at_onset(&self, amplitude: f64) -> bool {
        (amplitude / self.onset_amplitude() - 1.0).abs() < ARTEFACT
    }

    fn folds_on(&self, order: Order, arc: &Arc) -> Vec<SteadyState> {
        let determinant = |a: f64, frequency: f64| {
            self.trace_and_determinant(order, &self.steady_state(order, a, frequency))
                .1
        };
        let values: Vec<f64> = arc.nodes.iter().map(|&(a, w)| determinant(a, w)).collect();
        let mut folds = Vec::new();
        for (pair, value) in arc.nodes.windows(2).zip(values.windows(2)) {
            if value[0] * value[1] < 0.0 {
                let at = |a: f64| Some(determinant(a, self.root(order, arc.root, a)?));
                let amplitude = bisect(pair[0].0, pair[1].0, value[0] > 0.0, &at);
                if let Some(frequency) = self.root(order, arc.root, amplitude) {
                    folds.push(self.steady_state(order, amplitude, frequency));
                }
            }
        }
        folds
    }

    fn arcs(&self, order: Order) -> Vec<Arc> {
        let onset = self.onset_amplitude();
        let largest = match order {
            Order::First => self.largest_amplitude(),
            Order::Second => BEYOND * self.largest_amplitude(),
        };
        let smallest = SMALLEST
            * (self.load().abs() / self.frequency().powi(2))
                .min(onset)
                .min(largest);
        let ratio = (largest / smallest).powf(1.0 / NODES as f64);
        let mut amplitudes: Vec<f64> = (0..NODES).map(|i| smallest * ratio.powi(i as i32)).collect();
        amplitudes.push(largest);
        for i in 0..GRADED {
            let distance = 0.3 * (i as f64 / GRADED as f64).powi(4);
            amplitudes.push(onset * (1.0 + distance));
            amplitudes.push(onset * (1.0 - distance));
        }
        amplitudes.retain(|a| *a <= largest);
        amplitudes.sort_by(f64::total_cmp);
        amplitudes.dedup();
        let roots: Vec<[Option<f64>; 2]> = amplitudes.iter().map(|a| self.frequencies(order, *a)).collect();
        let mut arcs = Vec::new();
        for (index, root) in [Root::Lower, Root::Upper].into_iter().enumerate() {
            let mut nodes: Vec<(f64, f64)> = Vec::new();
            for i in 0..amplitudes.len() {
                if let Some(frequency) = roots[i][index] {
                    if nodes.is_empty() && i > 0 {
                        nodes = self.towards_end(order, root, amplitudes[i], amplitudes[i - 1]);
                        nodes.reverse();
                    }
                    nodes.push((amplitudes[i], frequency));
                } else if let Some(&(last, _)) = nodes.last() {
                    nodes.extend(self.towards_end(order, root, last, amplitudes[i]));
                    let nodes = std::mem::take(&mut nodes);
                    arcs.push(Arc { root, nodes });
                }
            }
            if !nodes.is_empty() {
                arcs.push(Arc { root, nodes });
            }
        }
        arcs
    }

    /// Nodes from an amplitude inside an arc towards its end before another outside, denser towards the end.
    fn towards_end(&self, order: Order, root: Root, inside: f64, outside: f64) -> Vec<(f64, f64)> {
        let (mut last, mut beyond) = (inside, outside);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (last + beyond);
            if self.root(order, root, middle).is_some() {
                last = middle;
            } else {
                beyond = middle;
            }
        }
        let nodes = (1..=GRADED).map(|i| {
            let rest = 1.0 - i as f64 / GRADED as f64;
            let a = last + (inside - last) * rest * rest;
            Some((a, self.root(order, root, a)?))
        });
        nodes.flatten().collect()
    }
}

/// The zero between two amplitudes, at the first of which the value is positive or not; where there is no value the
/// bracket shrinks towards the first.
fn bisect(first: f64, second: f64, positive: bool, value: &dyn Fn(f64) -> Option<f64>) -> f64 {
    let (mut near, mut far) = (first, second);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        match value(middle) {
            Some(value) if (value > 0.0) == positive => near = middle,
            _ => far = middle,
        }
    }
    0.5 * (near + far)
}

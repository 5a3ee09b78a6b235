//! Timeline of regimes: when the elements of a drive lock, overrun, stick, slip or touch, below curves over the
//! same time.

use super::curve_family::curves_panel;
use super::engagement_strip::{DISENGAGED, ENGAGED, within_period};
use super::lanes::{Lane, Stretch, lane_panel, mark_height};
use super::{Curve, FigureOptions, TimePanel};
use crate::plot::{Axis, Color, Figure, Layer, LegendEntry, LegendPlace, Marker, Panel, Shape, Stroke};

/// Input of [`regime_timeline`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RegimeTimeline {
    /// Time, or the phase within the period.
    pub time: Axis,
    /// Curves above the lanes, from top to bottom: for a clutch the speeds of pulley and accessory and the
    /// torque, for an arm its angle and the friction torque.
    pub panels: Vec<TimePanel>,
    /// The elements, from top to bottom.
    pub lanes: Vec<RegimeLane>,
    /// Curves, intervals and events are one period, drawn several times; once and as they are when absent.
    pub repetition: Option<Repetition>,
}

/// How often a period is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Repetition {
    /// Length of the period in units of the time axis; it starts at 0.
    pub period: f64,
    /// Number of periods, at most 50.
    pub count: usize,
}

/// An element over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RegimeLane {
    /// Its name, for example `alternator clutch`; cut when it is wider than 25 mm.
    pub name: String,
    /// Its regimes.
    pub intervals: Vec<RegimeInterval>,
    /// Its events.
    pub events: Vec<TimelineEvent>,
}

/// A stretch of time in one regime.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegimeInterval {
    /// Start; with a repetition an interval may cross the end of the period.
    pub from: f64,
    /// End.
    pub to: f64,
    /// The regime between them.
    pub regime: Regime,
}

/// What an element does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// A clutch transmits torque.
    Locked,
    /// A clutch transmits none.
    Overrunning,
    /// Dry friction holds its element.
    Stick,
    /// Dry friction slips, the velocity is positive; drawn in the upper half of the lane.
    SlipPositive,
    /// Dry friction slips, the velocity is negative; drawn in the lower half of the lane.
    SlipNegative,
    /// A stop or a backlash is closed.
    Contact,
    /// A stop or a backlash is open.
    Free,
}

impl Regime {
    /// All regimes in the order of the legend.
    const ALL: [Regime; 7] = [
        Regime::Locked,
        Regime::Overrunning,
        Regime::Stick,
        Regime::SlipPositive,
        Regime::SlipNegative,
        Regime::Contact,
        Regime::Free,
    ];

    fn name(self) -> &'static str {
        match self {
            Regime::Locked => "locked",
            Regime::Overrunning => "overrunning",
            Regime::Stick => "stick",
            Regime::SlipPositive => "slip +",
            Regime::SlipNegative => "slip −",
            Regime::Contact => "contact",
            Regime::Free => "free",
        }
    }

    fn color(self) -> Color {
        match self {
            Regime::Locked => ENGAGED,
            Regime::Overrunning => DISENGAGED,
            Regime::Stick => Color(70, 70, 70),
            Regime::SlipPositive => Color::ORANGE,
            Regime::SlipNegative => Color::SKY_BLUE,
            Regime::Contact => Color::VERMILLION,
            Regime::Free => Color(238, 238, 238),
        }
    }

    /// The part of the lane's height: the sign of slip must be visible without colours.
    fn height(self) -> [f64; 2] {
        match self {
            Regime::SlipPositive => [0.5, 1.0],
            Regime::SlipNegative => [0.0, 0.5],
            _ => [0.0, 1.0],
        }
    }
}

/// A change of regime worth a mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimelineEvent {
    /// When.
    pub time: f64,
    /// What.
    pub kind: RegimeEvent,
}

/// Kinds of events, each with a symbol of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RegimeEvent {
    /// A clutch locks.
    Locking,
    /// A clutch opens.
    Release,
    /// Dry friction stops its element.
    Stop,
    /// Dry friction breaks away.
    BreakAway,
    /// Slip changes its sign without a stop.
    Reversal,
    /// A stop is hit.
    Impact,
}

impl RegimeEvent {
    /// All kinds in the order of the legend.
    const ALL: [RegimeEvent; 6] = [
        RegimeEvent::Locking,
        RegimeEvent::Release,
        RegimeEvent::Stop,
        RegimeEvent::BreakAway,
        RegimeEvent::Reversal,
        RegimeEvent::Impact,
    ];

    fn name(self) -> &'static str {
        match self {
            RegimeEvent::Locking => "locking",
            RegimeEvent::Release => "release",
            RegimeEvent::Stop => "stop",
            RegimeEvent::BreakAway => "break-away",
            RegimeEvent::Reversal => "reversal",
            RegimeEvent::Impact => "impact",
        }
    }

    fn marker(self) -> Marker {
        match self {
            RegimeEvent::Locking => Marker::filled(Shape::TriangleDown, 3.4, Color::BLACK),
            RegimeEvent::Release => Marker::open(Shape::TriangleUp, 3.4, Color::BLACK),
            RegimeEvent::Stop => Marker::filled(Shape::Square, 3.0, Color::BLACK),
            RegimeEvent::BreakAway => Marker::open(Shape::Square, 3.0, Color::BLACK),
            RegimeEvent::Reversal => Marker::filled(Shape::Diamond, 3.2, Color::BLACK),
            RegimeEvent::Impact => Marker::open(Shape::Asterisk, 4.4, Color::BLACK),
        }
    }
}

/// Hair lines of events through the curves.
const EVENT_LINE: Stroke = Stroke {
    color: Color(170, 170, 170),
    width: 0.35,
    dash: crate::plot::Dash::Solid,
};

/// Draws curves and, below them, a lane for each element with its regimes and events. Hair lines lead from the
/// events through the curves.
pub fn regime_timeline(input: &RegimeTimeline, options: &FigureOptions) -> Figure {
    let copies = Copies::new(input.repetition);
    let mut rows: Vec<Vec<Panel>> = input
        .panels
        .iter()
        .map(|panel| vec![curve_panel(input, panel, &copies)])
        .collect();
    let curves = rows.len() as f64;
    let mut figure_legend = Vec::new();
    if !input.lanes.is_empty() {
        let (panel, legend) = lanes(input, &copies);
        rows.push(vec![panel]);
        figure_legend = legend;
    }
    let lanes = 4.1 * input.lanes.len() as f64;
    let mut figure = options.figure(rows, 25.0 + lanes + 30.0 * curves, 22.0 + lanes + 34.0 * curves);
    figure.share_x = true;
    figure.legend = figure_legend;
    figure
}

/// The copies of a period.
struct Copies {
    period: Option<f64>,
    shifts: Vec<f64>,
}

impl Copies {
    fn new(repetition: Option<Repetition>) -> Self {
        const MOST: usize = 50;
        match repetition {
            Some(Repetition { period, count }) if period.is_finite() && period > 0.0 => Copies {
                period: Some(period),
                shifts: (0..count.clamp(1, MOST)).map(|i| i as f64 * period).collect(),
            },
            _ => Copies {
                period: None,
                shifts: vec![0.0],
            },
        }
    }

    fn curve(&self, curve: &Curve) -> Curve {
        let mut copies = Curve {
            name: curve.name.clone(),
            ..Curve::default()
        };
        let count = curve.x.len().min(curve.y.len());
        for shift in &self.shifts {
            copies.x.extend(curve.x[..count].iter().map(|x| x + shift));
            copies.y.extend_from_slice(&curve.y[..count]);
        }
        copies
    }

    fn interval(&self, interval: &RegimeInterval) -> Vec<[f64; 2]> {
        let Some(period) = self.period else {
            return vec![[interval.from, interval.to]];
        };
        let parts = within_period([interval.from / period, interval.to / period]);
        let at = |shift: f64| move |phase: f64| shift + phase * period;
        self.shifts
            .iter()
            .flat_map(|shift| parts.iter().map(|part| part.map(at(*shift))))
            .collect()
    }

    fn time(&self, time: f64) -> Vec<f64> {
        let time = self.period.map_or(time, |period| time.rem_euclid(period));
        self.shifts.iter().map(|shift| time + shift).collect()
    }
}

fn curve_panel(input: &RegimeTimeline, panel: &TimePanel, copies: &Copies) -> Panel {
    let curves: Vec<Curve> = panel.curves.iter().map(|curve| copies.curve(curve)).collect();
    let events = input.lanes.iter().flat_map(|lane| &lane.events);
    let lines = Layer::Uprights {
        x: events.flat_map(|event| copies.time(event.time)).collect(),
        stroke: EVENT_LINE,
    };
    let mut panel = curves_panel(input.time.clone(), panel.y.clone(), &curves);
    panel.layers.insert(0, lines);
    panel.legend_place = LegendPlace::Above;
    panel
}

fn lanes(input: &RegimeTimeline, copies: &Copies) -> (Panel, Vec<LegendEntry>) {
    let lanes: Vec<Lane> = input
        .lanes
        .iter()
        .map(|lane| Lane {
            name: &lane.name,
            stretches: lane
                .intervals
                .iter()
                .flat_map(|interval| {
                    copies.interval(interval).into_iter().map(|x| Stretch {
                        x,
                        height: interval.regime.height(),
                        color: interval.regime.color(),
                    })
                })
                .collect(),
        })
        .collect();
    let count = lanes.len();
    let mut panel = lane_panel(input.time.clone(), &lanes);
    let mut legend: Vec<LegendEntry> = Vec::new();
    let intervals = || input.lanes.iter().flat_map(|lane| &lane.intervals);
    for regime in Regime::ALL {
        if intervals().any(|interval| interval.regime == regime) {
            legend.push(LegendEntry::fill(regime.name(), regime.color()));
        }
    }
    for kind in RegimeEvent::ALL {
        let mut points = Vec::new();
        for (index, lane) in input.lanes.iter().enumerate() {
            let events = lane.events.iter().filter(|event| event.kind == kind);
            let times = events.flat_map(|event| copies.time(event.time));
            points.extend(times.map(|time| [time, mark_height(index, count)]));
        }
        if !points.is_empty() {
            let marker = kind.marker();
            panel.layers.push(Layer::Points { points, marker });
            legend.push(LegendEntry::marker(kind.name(), marker));
        }
    }
    (panel, legend)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_period_is_repeated_and_its_end_crossed() {
        let copies = Copies::new(Some(Repetition {
            period: 2.0,
            count: 2,
        }));
        let interval = RegimeInterval {
            from: 1.5,
            to: 2.5,
            regime: Regime::Locked,
        };
        assert_eq!(
            copies.interval(&interval),
            [[1.5, 2.0], [0.0, 0.5], [3.5, 4.0], [2.0, 2.5]]
        );
        assert_eq!(copies.time(2.5), [0.5, 2.5]);
        let curve = Curve {
            x: vec![0.0, 1.0],
            y: vec![3.0, 4.0, 5.0],
            ..Curve::default()
        };
        assert_eq!(copies.curve(&curve).x, [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(copies.curve(&curve).y, [3.0, 4.0, 3.0, 4.0]);
    }

    #[test]
    fn without_a_period_times_stay_as_they_are() {
        for repetition in [
            None,
            Some(Repetition {
                period: 0.0,
                count: 3,
            }),
        ] {
            let copies = Copies::new(repetition);
            assert_eq!(copies.time(-2.5), [-2.5]);
        }
    }
}

//! Regimes and events by name as timelines draw them.

use slackside_report::figures::{Regime, RegimeEvent, RegimeInterval, RegimeLane, TimelineEvent};
use slackside_studies::{Event, Named, Ratios};

/// How a regime is drawn, by its name in documents.
pub fn regime(name: &str) -> Option<Regime> {
    Some(match name {
        "locked" | "engaged" | "driving" => Regime::Locked,
        "overrunning" | "free-wheeling" | "disengaged" => Regime::Overrunning,
        "stick" => Regime::Stick,
        "slip+" => Regime::SlipPositive,
        "slip-" => Regime::SlipNegative,
        "contact" => Regime::Contact,
        "free" | "released" => Regime::Free,
        _ => return None,
    })
}

/// Whether an element is one that opens: a clutch, not friction and no stop.
pub fn is_clutch(shares: &Ratios) -> bool {
    shares
        .0
        .iter()
        .any(|(name, _)| regime(name) == Some(Regime::Overrunning))
}

/// Whether an element is dry friction.
pub fn is_friction(shares: &Ratios) -> bool {
    shares
        .0
        .iter()
        .any(|(name, _)| regime(name) == Some(Regime::Stick))
}

/// The mark of an event.
fn mark(from: &str, to: &str) -> Option<RegimeEvent> {
    Some(match (regime(from)?, regime(to)?) {
        (_, Regime::Locked) => RegimeEvent::Locking,
        (_, Regime::Overrunning) => RegimeEvent::Release,
        (_, Regime::Stick) => RegimeEvent::Stop,
        (Regime::Stick, _) => RegimeEvent::BreakAway,
        (Regime::Free, Regime::Contact) => RegimeEvent::Impact,
        (_, Regime::SlipPositive | Regime::SlipNegative) => RegimeEvent::Reversal,
        (_, Regime::Contact | Regime::Free) => return None,
    })
}

/// A lane for each element: `events` with their times in order, `shares` of the regimes, from `start` to `end`.
/// `repeats` tells that the stretch is a period, so that what holds at its end holds at its start.
pub fn lanes(
    events: &[(f64, &Event)],
    shares: &Named<Ratios>,
    [start, end]: [f64; 2],
    repeats: bool,
) -> Vec<RegimeLane> {
    let lane = |(element, shares): &(String, Ratios)| {
        let own: Vec<&(f64, &Event)> = events
            .iter()
            .filter(|(_, event)| event.element == *element)
            .collect();
        let mut lane = RegimeLane {
            name: element.clone(),
            ..RegimeLane::default()
        };
        let mut push = |from: f64, to: f64, name: &str| {
            let (from, to) = (from.max(start), to.min(end));
            if let Some(regime) = regime(name).filter(|_| to > from) {
                lane.intervals.push(RegimeInterval { from, to, regime });
            }
        };
        match (own.first(), own.last()) {
            (Some(first), Some(last)) => {
                push(start, first.0, if repeats { &last.1.to } else { &first.1.from });
                for (i, (time, event)) in own.iter().enumerate() {
                    push(*time, own.get(i + 1).map_or(end, |next| next.0), &event.to);
                }
            }
            _ => {
                let held = shares.0.iter().max_by(|a, b| a.1.total_cmp(&b.1));
                push(start, end, held.map_or("", |(name, _)| name));
            }
        }
        lane.events = own
            .iter()
            .filter(|(time, _)| (start..=end).contains(time))
            .filter_map(|(time, event)| {
                Some(TimelineEvent {
                    time: *time,
                    kind: mark(&event.from, &event.to)?,
                })
            })
            .collect();
        lane
    };
    shares.0.iter().map(lane).collect()
}

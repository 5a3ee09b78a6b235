//! When an element transmits within a period.

use slackside_studies::{Event, Motion};

/// The element that engages and disengages in some of the motions: the first that has such an event. Dry friction sticks and slips,
/// which is told elsewhere.
pub fn switching_element<'a>(motions: impl Iterator<Item = &'a Motion>) -> Option<&'a str> {
    let of_friction = |event: &Event| matches!(event.to.as_str(), "stick" | "slip+" | "slip-");
    motions
        .flat_map(|motion| &motion.events)
        .find(|event| !of_friction(event))
        .map(|event| event.element.as_str())
}

/// Engaged intervals of the phase of an element; an interval may run past 1.
pub fn engaged(motion: &Motion, element: &str) -> Vec<[f64; 2]> {
    let of_element: Vec<&Event> = motion
        .events
        .iter()
        .filter(|event| event.element == element)
        .collect();
    let Some(first) = of_element.first() else {
        let ratios = motion.engaged_ratios.as_ref();
        let ratio = ratios.map_or(motion.engaged_ratio, |ratios| ratios.get(element));
        return if ratio.unwrap_or(1.0) > 0.5 {
            vec![[0.0, 1.0]]
        } else {
            Vec::new()
        };
    };
    let mut intervals = Vec::new();
    for (i, event) in of_element.iter().enumerate() {
        if event.engaged {
            let end = of_element.get(i + 1).map_or(first.phase + 1.0, |next| next.phase);
            intervals.push([event.phase, end]);
        }
    }
    intervals
}

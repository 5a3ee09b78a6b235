//! When an element transmits within a period.

use slackside_studies::Event;

/// Engaged intervals of the phase of the element that is named first; an interval may run past 1.
pub fn engaged(events: &[Event], ratio: f64) -> Vec<[f64; 2]> {
    let Some(first) = events.first() else {
        return if ratio > 0.5 { vec![[0.0, 1.0]] } else { Vec::new() };
    };
    let of_element: Vec<&Event> = events
        .iter()
        .filter(|event| event.element == first.element)
        .collect();
    let mut intervals = Vec::new();
    for (i, event) in of_element.iter().enumerate() {
        if event.engaged {
            let end = of_element
                .get(i + 1)
                .map_or(of_element[0].phase + 1.0, |next| next.phase);
            intervals.push([event.phase, end]);
        }
    }
    intervals
}

//! The drawing of a drive from its steady sheet.

use slackside_report::figures::{DriveLayout, LayoutPulley, LayoutSpan, LayoutTensioner, TensionerMount};
use slackside_studies::drive::steady::{PulleyRow, SteadyDocument, TensionerRow};

/// The drive of a steady sheet; loads and tensions are written beside pulleys and spans.
pub fn layout(sheet: &SteadyDocument) -> DriveLayout {
    let count = sheet.pulleys.len();
    let pulley = |(j, pulley): (usize, &PulleyRow)| {
        let before = &sheet.spans[(j + count - 1) % count];
        LayoutPulley {
            label: (j + 1).to_string(),
            name: pulley.name.clone(),
            center: pulley.center,
            radius: pulley.radius,
            sense: pulley.sense,
            tangent_in: before.ends[1],
            tangent_out: sheet.spans[j].ends[0],
            wrap: pulley.wrap,
            driver: pulley.driver,
            carried: pulley.tensioner.is_some(),
            note: if pulley.torque == 0.0 {
                String::new()
            } else {
                format!("{:.1} N m", pulley.torque)
            },
            hub_load: Some(pulley.hub_load),
        }
    };
    DriveLayout {
        pulleys: sheet.pulleys.iter().enumerate().map(pulley).collect(),
        spans: sheet
            .spans
            .iter()
            .enumerate()
            .map(|(i, span)| LayoutSpan {
                label: format!("span {}", i + 1),
                start: span.ends[0],
                end: span.ends[1],
                note: format!("{:.0} N", span.tension),
            })
            .collect(),
        tensioners: sheet.tensioners.iter().map(|row| tensioner(sheet, row)).collect(),
    }
}

/// Pulleys that a tensioner carries.
pub fn carried<'a>(sheet: &'a SteadyDocument, tensioner: &'a str) -> impl Iterator<Item = usize> + 'a {
    sheet
        .pulleys
        .iter()
        .enumerate()
        .filter(move |(_, pulley)| pulley.tensioner.as_deref() == Some(tensioner))
        .map(|(j, _)| j)
}

fn tensioner(sheet: &SteadyDocument, row: &TensionerRow) -> LayoutTensioner {
    let centers: Vec<[f64; 2]> = carried(sheet, &row.name)
        .map(|j| sheet.pulleys[j].center)
        .collect();
    let mount = match (row.pivot, row.direction) {
        (Some(pivot), _) => TensionerMount::Rotary {
            pivot,
            stops: row.stops.map(|stops| {
                // The drawn angle is that of the first centre, which may stand beside the arm's line.
                let beside = centers.first().map_or(0.0, |center| {
                    (center[1] - pivot[1]).atan2(center[0] - pivot[0]) - row.angle.unwrap_or_default()
                });
                stops.map(|stop| stop + beside)
            }),
        },
        (None, direction) => TensionerMount::Linear {
            direction: direction.unwrap_or([1.0, 0.0]),
            stops: row
                .stops
                .map(|stops| stops.map(|stop| stop - row.position.unwrap_or_default())),
        },
    };
    LayoutTensioner {
        name: row.name.clone(),
        mount,
        centers,
    }
}

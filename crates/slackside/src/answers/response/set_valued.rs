//! Figures of periodic motions with clutches, friction and stops over a parameter.

use super::{Choice, Statistic};
use crate::answers::regimes::{is_clutch, is_friction};
use crate::plots;
use slackside_report::Figure;
use slackside_report::figures::{
    CertifiedCurve, CertifiedMeasure, CertifiedResponse, ComparedMeasure, Comparison, Curve, Dissipation,
    DissipationCurve, EngagedRatio, EngagedRatioCurve, FrictionRegion, FrictionRegionKind, RangeWarning,
    ResponseSpectrum, ReversalCounters, TensionExtremes, TensionRange, TensionRangePanel, Waterfall,
    certified_response, comparison, dissipation, engaged_ratio, tension_extremes, waterfall_orders,
};
use slackside_report::plot::Axis;
use slackside_studies::response::{BranchRow, PointRow, ResponseDocument};

/// Groups of measures of a drive that share a figure: prefix, name, title of the axis.
const GROUPS: [(&str, &str, &str); 6] = [
    ("arm.", "arms", "RMS of arm motion"),
    ("rotation.", "rotations", "RMS of rotation"),
    ("clutch_torque.", "clutch_torques", "RMS of clutch torque"),
    ("tension.", "tension_rms", "RMS of tension"),
    ("hub_load.", "hub_loads", "RMS of hub load"),
    ("deflection.", "deflections", "RMS of deflection"),
];
/// Share of the work of the load below which an element dissipates nothing.
const NOTHING: f64 = 1e-9;
/// Highest order of a waterfall.
const ORDERS: usize = 15;

/// All figures but those of single motions.
pub fn all(document: &ResponseDocument, choice: &Choice) -> Vec<(String, Figure)> {
    let mut figures = vec![("response".to_owned(), certified(document, choice))];
    figures.extend(
        GROUPS
            .iter()
            .filter_map(|(prefix, name, title)| Some(((*name).to_owned(), group(document, prefix, title)?))),
    );
    let named = [
        ("engaged_ratio", ratios(document)),
        ("dissipation", dissipated(document)),
        ("tensions", tensions(document)),
        ("waterfall", waterfall(document, &choice.measure)),
    ];
    figures.extend(
        named
            .into_iter()
            .filter_map(|(name, figure)| Some((name.to_owned(), figure?))),
    );
    figures
}

fn x_axis(document: &ResponseDocument) -> Axis {
    plots::axis(&document.parameter.key, &document.parameter.unit)
}

fn name(branch: &BranchRow) -> String {
    branch.label.as_ref().map_or_else(String::new, plots::label)
}

/// Branches of which one is drawn per member of the family: the longest, the response from below.
fn main_branches(document: &ResponseDocument) -> Vec<&BranchRow> {
    let mut main: Vec<&BranchRow> = Vec::new();
    for branch in &document.branches {
        match main.iter_mut().find(|known| known.label == branch.label) {
            Some(known) if known.points.len() < branch.points.len() => *known = branch,
            Some(_) => {}
            None => main.push(branch),
        }
    }
    main
}

fn curve(branch: &BranchRow, name: String, y: &dyn Fn(&PointRow) -> f64) -> Curve {
    Curve {
        name,
        x: branch.points.iter().map(|point| point.at.value).collect(),
        y: branch.points.iter().map(y).collect(),
    }
}

/// The chosen measure with certificate and warnings.
fn certified(document: &ResponseDocument, choice: &Choice) -> Figure {
    let unique = |branch: &BranchRow, value: f64| {
        let mut rows = document.uniqueness.iter();
        rows.any(|row| row.label == branch.label && row.no_jumps && (row.from..=row.to).contains(&value))
    };
    let curves = document.branches.iter().map(|branch| CertifiedCurve {
        name: name(branch),
        x: branch.points.iter().map(|point| point.at.value).collect(),
        y: branch
            .points
            .iter()
            .map(|point| choice.of(&point.motion.measures))
            .collect(),
        unique: branch
            .points
            .iter()
            .map(|point| unique(branch, point.at.value))
            .collect(),
    });
    certified_response(
        &CertifiedResponse {
            x: x_axis(document),
            measures: vec![CertifiedMeasure {
                y: choice.axis(&document.header),
                curves: curves.collect(),
            }],
            warnings: warnings(document),
        },
        &plots::options(),
    )
}

/// Where spans are slack and the belt would slip.
fn warnings(document: &ResponseDocument) -> Vec<RangeWarning> {
    let mut warnings: Vec<RangeWarning> = Vec::new();
    for (kind, lane, text) in [
        ("slack-span", "slack span", "which the model does not see"),
        ("gross-slip", "gross slip", "which the model does not see"),
    ] {
        let mut places: Vec<&str> = Vec::new();
        let mut intervals = Vec::new();
        for branch in &document.branches {
            let mut open: Option<[f64; 2]> = None;
            for point in &branch.points {
                let remarks = point.trust.iter().flat_map(|trust| &trust.remarks);
                let here: Vec<&str> = remarks
                    .filter(|remark| remark.kind == kind)
                    .map(|remark| remark.at.as_str())
                    .collect();
                if here.is_empty() {
                    intervals.extend(open.take());
                } else {
                    open = Some(open.map_or([point.at.value; 2], |[from, _]| [from, point.at.value]));
                }
                for place in here {
                    if !places.contains(&place) {
                        places.push(place);
                    }
                }
            }
            intervals.extend(open);
        }
        if !intervals.is_empty() {
            warnings.push(RangeWarning {
                name: lane.to_owned(),
                text: format!("{}, {text}", places.join(", ")),
                intervals,
            });
        }
    }
    warnings
}

/// RMS of all measures of a group, a panel each, with a curve for each member of the family.
fn group(document: &ResponseDocument, prefix: &str, title: &str) -> Option<Figure> {
    let names = document.header.units.measures.0.iter();
    let measures = names.filter_map(|(measure, unit)| {
        let rest = measure
            .strip_prefix(prefix)
            .filter(|rest| !rest.ends_with(".rate"))?;
        let (unit, factor) = match (unit.as_str(), prefix) {
            ("rad", _) => ("°", 1f64.to_degrees()),
            ("m", _) => ("mm", 1e3),
            (unit, _) => (unit, 1.0),
        };
        let rms = |point: &PointRow| {
            let measure = point.motion.measures.get(measure);
            measure.map_or(f64::NAN, |measure| factor * measure.rms)
        };
        let curves = main_branches(document)
            .into_iter()
            .map(|branch| curve(branch, name(branch), &rms));
        Some(ComparedMeasure {
            heading: rest.to_owned(),
            y: Axis::linear(title, unit),
            curves: curves.collect(),
        })
    });
    let measures: Vec<ComparedMeasure> = measures.collect();
    (!measures.is_empty()).then(|| {
        comparison(
            &Comparison {
                x: x_axis(document),
                measures,
            },
            &plots::options(),
        )
    })
}

/// Names of the elements of a kind that any motion has.
fn elements(document: &ResponseDocument, of: &dyn Fn(&PointRow, &str) -> bool) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for branch in &document.branches {
        for point in &branch.points {
            for (element, _) in &point.motion.regimes.0 {
                if !found.contains(element) && of(point, element) {
                    found.push(element.clone());
                }
            }
        }
    }
    found
}

/// Name of a curve of an element in a family; the element is named where there are several.
fn of_element(branch: &BranchRow, element: &str, several: bool) -> String {
    match (name(branch), several) {
        (label, false) => label,
        (label, true) if label.is_empty() => element.to_owned(),
        (label, true) => format!("{element}, {label}"),
    }
}

/// Share of time in which each clutch is engaged.
fn ratios(document: &ResponseDocument) -> Option<Figure> {
    let clutches = elements(document, &|point, element| {
        point.motion.regimes.get(element).is_some_and(is_clutch)
    });
    let ratio = |point: &PointRow, element: &str| match &point.motion.engaged_ratios {
        Some(ratios) => ratios.get(element).unwrap_or(f64::NAN),
        None => point.motion.engaged_ratio.unwrap_or(f64::NAN),
    };
    let mut curves = Vec::new();
    for branch in main_branches(document) {
        for element in &clutches {
            let curve = curve(
                branch,
                of_element(branch, element, clutches.len() > 1),
                &|point| ratio(point, element),
            );
            if curve.y.iter().all(|value| value.is_nan()) {
                continue;
            }
            // The clutch stays locked from the first value behind which it never opens again.
            let open = curve.y.iter().rposition(|ratio| *ratio < 1.0);
            let critical = open.and_then(|last| curve.x.get(last + 1).copied());
            curves.push(EngagedRatioCurve { curve, critical });
        }
    }
    let opens = |curve: &EngagedRatioCurve| curve.curve.y.iter().any(|ratio| *ratio < 1.0);
    curves.iter().any(opens).then(|| {
        engaged_ratio(
            &EngagedRatio {
                x: x_axis(document),
                ratio: Axis::linear("Engaged-time ratio", "–"),
                curves,
            },
            &plots::options(),
        )
    })
}

/// What friction dissipates in a period, with its optimum, the kinds of motion and the counters of a single curve.
fn dissipated(document: &ResponseDocument) -> Option<Figure> {
    let takes = |point: &PointRow, element: &str| {
        let load = point.motion.energy.map_or(0.0, |energy| energy.load.abs());
        let row = point.motion.elements.get(element);
        row.is_some_and(|row| (row.dissipation + row.impact_loss).abs() > NOTHING * load)
    };
    let mut dissipating = elements(document, &takes);
    // Where the optimum of one element is asked for, it is drawn alone.
    let is_asked = |element: &String| document.optimum.iter().any(|row| of_optimum(&row.of, element));
    if dissipating.iter().any(is_asked) {
        dissipating.retain(is_asked);
    }
    let energy = |point: &PointRow, element: &str| {
        let row = point.motion.elements.get(element);
        row.map_or(f64::NAN, |row| row.dissipation + row.impact_loss)
    };
    let several = dissipating.len() > 1;
    let branches = main_branches(document);
    let mut curves = Vec::new();
    for branch in &branches {
        for element in &dissipating {
            let found = document.optimum.iter().find(|row| {
                row.label == branch.label
                    && (of_optimum(&row.of, element) || (row.of == "dissipation" && !several))
            });
            curves.push(DissipationCurve {
                curve: curve(branch, of_element(branch, element, several), &|point| {
                    energy(point, element)
                }),
                optimum: found.map(|row| [row.at.value, row.value]),
            });
        }
    }
    if curves.is_empty() {
        return None;
    }
    let single = match (branches.as_slice(), dissipating.as_slice()) {
        ([branch], [element]) => Some((*branch, element.as_str())),
        _ => None,
    };
    let friction = single.filter(|(branch, element)| {
        let mut points = branch.points.iter();
        points.any(|point| point.motion.regimes.get(element).is_some_and(is_friction))
    });
    Some(dissipation(
        &Dissipation {
            torque: x_axis(document),
            energy: Axis::linear("Dissipation in a period", energy_unit(document)),
            curves,
            regions: friction.map_or_else(Vec::new, |(branch, element)| regions(branch, element)),
            counters: friction.map(|(branch, element)| counters(branch, element)),
        },
        &plots::options(),
    ))
}

/// Whether an optimum is that of the dissipation of an element.
fn of_optimum(of: &str, element: &str) -> bool {
    let short = element.strip_prefix("friction.").unwrap_or(element);
    let name = of.strip_prefix("dissipation.");
    name.is_some_and(|name| name == element || name == short)
}

fn energy_unit(document: &ResponseDocument) -> &'static str {
    match document.header.units.torque.as_str() {
        "N m" | "N·m" => "J",
        _ => "–",
    }
}

/// Intervals of the parameter in which friction slips, sticks at times or sticks for all time.
fn regions(branch: &BranchRow, element: &str) -> Vec<FrictionRegion> {
    let kind = |point: &PointRow| {
        let shares = point.motion.regimes.get(element)?;
        let stick = shares.get("stick")?;
        Some(match stick {
            0.0 => FrictionRegionKind::Slip,
            share if share >= 1.0 - 1e-9 => FrictionRegionKind::Locked,
            _ => FrictionRegionKind::StickSlip,
        })
    };
    let mut regions: Vec<FrictionRegion> = Vec::new();
    let mut before: Option<f64> = None;
    for point in &branch.points {
        let value = point.at.value;
        if let Some(kind) = kind(point) {
            match regions.last_mut() {
                Some(region) if region.kind == kind => region.to = value,
                last => {
                    // The kind changes somewhere between two values.
                    let from = before.map_or(value, |before| 0.5 * (before + value));
                    if let Some(region) = last {
                        region.to = from;
                    }
                    regions.push(FrictionRegion {
                        from,
                        to: value,
                        kind,
                    });
                }
            }
        }
        before = Some(value);
    }
    regions
}

fn counters(branch: &BranchRow, element: &str) -> ReversalCounters {
    let count = |of: &dyn Fn(&slackside_studies::ElementRow) -> f64| {
        let value = |point: &PointRow| point.motion.elements.get(element).map_or(f64::NAN, of);
        curve(branch, String::new(), &value)
    };
    ReversalCounters {
        count: Axis::linear("Count", "–"),
        // A motion that repeats reverses an even number of times.
        reversals: count(&|row| row.velocity_reversals.map_or(f64::NAN, |count| count as f64)),
        stops: count(&|row| 0.5 * row.stops as f64),
    }
}

/// Extremes of the tension of each span, with its steady value.
fn tensions(document: &ResponseDocument) -> Option<Figure> {
    let names = document.header.units.measures.0.iter();
    let spans: Vec<&str> = names
        .filter_map(|(name, _)| name.strip_prefix("tension."))
        .collect();
    let panels = spans.iter().map(|span| {
        let measure = format!("tension.{span}");
        let ranges = main_branches(document).into_iter().map(|branch| {
            let steady = |point: &PointRow| {
                let trust = point.trust.as_ref();
                trust.and_then(|trust| trust.steady.get(&measure)).unwrap_or(0.0)
            };
            let of = |statistic: Statistic| {
                let choice = Choice {
                    measure: measure.clone(),
                    statistic,
                };
                let points = branch.points.iter();
                points
                    .map(|point| choice.of(&point.motion.measures) - steady(point))
                    .collect::<Vec<f64>>()
            };
            TensionRange {
                name: name(branch),
                x: branch.points.iter().map(|point| point.at.value).collect(),
                static_tension: branch.points.iter().map(steady).collect(),
                min: of(Statistic::Min),
                max: of(Statistic::Max),
            }
        });
        TensionRangePanel {
            heading: (*span).to_owned(),
            ranges: ranges.collect(),
        }
    });
    let panels: Vec<TensionRangePanel> = panels.collect();
    let has_steady = document
        .branches
        .iter()
        .flat_map(|branch| &branch.points)
        .any(|point| point.trust.as_ref().is_some_and(|trust| !trust.steady.is_empty()));
    (has_steady && !panels.is_empty()).then(|| {
        tension_extremes(
            &TensionExtremes {
                x: x_axis(document),
                tension: Axis::linear("Tension", "N"),
                panels,
            },
            &plots::options(),
        )
    })
}

/// Harmonics of the chosen measure over the parameter, of the first member of the family.
fn waterfall(document: &ResponseDocument, measure: &str) -> Option<Figure> {
    let branch = *main_branches(document).first()?;
    let spectra = branch.points.iter().filter_map(|point| {
        let harmonics = &point.motion.measures.get(measure)?.harmonics;
        let lines = harmonics.iter().enumerate().skip(1).take(ORDERS);
        let (frequency, amplitude): (Vec<f64>, Vec<f64>) = lines
            .map(|(order, [re, im])| (order as f64, re.hypot(*im)))
            .unzip();
        (!frequency.is_empty()).then_some(ResponseSpectrum {
            parameter: point.at.value,
            frequency,
            amplitude,
        })
    });
    let spectra: Vec<ResponseSpectrum> = spectra.collect();
    let every = spectra.len().div_ceil(60).max(1);
    let spectra: Vec<ResponseSpectrum> = spectra.into_iter().step_by(every).collect();
    (spectra.len() > 1).then(|| {
        waterfall_orders(
            &Waterfall {
                parameter: x_axis(document),
                frequency: Axis::linear("Order of the load", "–"),
                amplitude: Axis::linear(
                    format!("Amplitude of {}", plots::words(measure)),
                    document.header.units.measures.get(measure),
                ),
                spectra,
            },
            &plots::options(),
        )
    })
}

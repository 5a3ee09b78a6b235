//! The figures of a recipe: those of its commands, and those drawn from columns of their tables.

use super::columns::{column, numbers, rows, texts, values};
use super::recipe::{Plot, PlotAxis, PlotCurve, Show, Style};
use crate::plots;
use slackside_report::figures::{
    Branch, Curve, CurveFamily, PoincareMap, PointSet, Response, Spectrum, SpectrumStyle, curve_family,
    poincare_map, response, spectrum,
};
use slackside_report::plot::{Axis, Scale};
use slackside_report::{Figure, Table};

/// Cuts the axes of a command's figure to the part that is shown.
pub fn cut(mut figure: Figure, show: &Show) -> Figure {
    for panel in figure.rows.iter_mut().flatten() {
        panel.x.limits = show.x.map(|[low, high]| (low, high)).or(panel.x.limits);
        panel.y.limits = show.y.map(|[low, high]| (low, high)).or(panel.y.limits);
    }
    figure
}

/// One line of a plot.
struct Line {
    name: String,
    x: Vec<f64>,
    y: Vec<f64>,
    stable: Vec<bool>,
}

/// Draws a plot; `table` finds a table by command and name.
///
/// # Errors
/// What is wrong with a column or an expression.
pub fn draw<'a>(
    plot: &Plot,
    table: &dyn Fn(&str, &str) -> Result<&'a Table, String>,
) -> Result<Figure, String> {
    let mut units = [None, None];
    let mut lines = Vec::new();
    for curve in &plot.curves {
        let table = table(&curve.command, &curve.table)?;
        if plot.style == Style::Profiles {
            profiles(curve, table, &mut lines)?;
        } else {
            lines_of(plot, curve, table, &mut units, &mut lines)?;
        }
    }
    let [x_unit, y_unit] = units;
    let mut x = axis(&plot.x, x_unit);
    if plot.style == Style::Profiles {
        x.names = (0..).map(f64::from).zip(plot.x.names.iter().cloned()).collect();
        x = x.with_limits(-0.25, plot.x.names.len() as f64 - 0.75);
    }
    let y = axis(&plot.y, y_unit);
    let options = plots::options();
    let curves = |lines: Vec<Line>| {
        let curves = lines.into_iter().map(|line| Curve {
            name: line.name,
            x: line.x,
            y: line.y,
        });
        curves.collect()
    };
    Ok(match plot.style {
        Style::Curves | Style::Profiles => curve_family(
            &CurveFamily {
                x,
                y,
                curves: curves(lines),
            },
            &options,
        ),
        Style::Branches => {
            let branches = lines.into_iter().map(|line| Branch {
                name: (!line.name.is_empty()).then_some(line.name),
                x: line.x,
                y: line.y,
                stable: line.stable,
                special: Vec::new(),
            });
            let branches = branches.collect();
            response(
                &Response {
                    x,
                    y,
                    branches,
                    ..Response::default()
                },
                &options,
            )
        }
        Style::Points => {
            let sets = lines.into_iter().map(|line| PointSet {
                name: line.name,
                points: line.x.into_iter().zip(line.y).map(|(x, y)| [x, y]).collect(),
            });
            poincare_map(
                &PoincareMap {
                    x,
                    y,
                    sets: sets.collect(),
                },
                &options,
            )
        }
        Style::Stems => spectrum(
            &Spectrum {
                frequency: x,
                amplitude: y,
                spectra: curves(lines),
                style: SpectrumStyle::Stems,
            },
            &options,
        ),
    })
}

/// A curve for each value of the family and each branch.
fn lines_of(
    plot: &Plot,
    curve: &PlotCurve,
    table: &Table,
    units: &mut [Option<String>; 2],
    lines: &mut Vec<Line>,
) -> Result<(), String> {
    let chosen = rows(table, &curve.filter)?;
    let key = |name: &str| table.columns.iter().find(|column| column.name == name).map(texts);
    let members = match &curve.split {
        Some(name) => texts(column(table, name)?),
        None => vec![String::new(); table.rows()],
    };
    let branches = key("branch").unwrap_or_else(|| vec![String::new(); table.rows()]);
    let stable = table.columns.iter().find(|column| column.name == "stable");
    let stable = stable.map(numbers).transpose()?;
    let mut groups: Vec<((&String, &String), Vec<usize>)> = Vec::new();
    for row in chosen {
        let of = (&members[row], &branches[row]);
        match groups.iter_mut().find(|(key, _)| *key == of) {
            Some((_, rows)) => rows.push(row),
            None => groups.push((of, vec![row])),
        }
    }
    for ((member, _), mut rows) in groups {
        if curve.sort {
            let (x, _) = values(table, &rows, &plot.x.value)?;
            let mut order: Vec<usize> = (0..rows.len()).collect();
            order.sort_by(|a, b| x[*a].total_cmp(&x[*b]));
            rows = order.into_iter().map(|i| rows[i]).collect();
        }
        let (x, x_unit) = values(table, &rows, &plot.x.value)?;
        let (y, y_unit) = values(table, &rows, curve.y.as_deref().unwrap_or(&plot.y.value))?;
        let [of_x, of_y] = units;
        *of_x = of_x.take().or(x_unit);
        *of_y = of_y.take().or(y_unit);
        lines.push(Line {
            name: curve.name.replace("{}", member),
            x,
            y,
            stable: stable.as_ref().map_or(Vec::new(), |flags| {
                rows.iter().map(|row| flags[*row] > 0.5).collect()
            }),
        });
    }
    Ok(())
}

/// A curve for each row over its columns; `{COLUMN}` in the name stands for the row's value.
fn profiles(curve: &PlotCurve, table: &Table, lines: &mut Vec<Line>) -> Result<(), String> {
    let columns = curve.columns.iter().map(|name| numbers(column(table, name)?));
    let columns = columns.collect::<Result<Vec<Vec<f64>>, String>>()?;
    for row in rows(table, &curve.filter)? {
        let mut name = curve.name.clone();
        for column in &table.columns {
            let mark = format!("{{{}}}", column.name);
            if name.contains(&mark) {
                name = name.replace(&mark, &texts(column)[row]);
            }
        }
        lines.push(Line {
            name,
            x: (0..columns.len()).map(|place| place as f64).collect(),
            y: columns.iter().map(|values| values[row]).collect(),
            stable: Vec::new(),
        });
    }
    Ok(())
}

/// The axis that the recipe describes, with what it leaves out taken from the column.
fn axis(given: &PlotAxis, unit: Option<String>) -> Axis {
    let unit = given.unit.clone().or(unit).unwrap_or_default();
    // Tables have no mark for what has no unit, axes do.
    let unit = if unit.is_empty() { "–".to_owned() } else { unit };
    let label = match &given.label {
        Some(label) => label.clone(),
        None => plots::capital(&plots::words(&given.value)),
    };
    let unit = if given.names.is_empty() {
        unit
    } else {
        String::new()
    };
    Axis {
        limits: given.limits.map(|[low, high]| (low, high)),
        scale: if given.logarithmic {
            Scale::Logarithmic
        } else {
            Scale::Linear
        },
        ..Axis::linear(label, unit)
    }
}

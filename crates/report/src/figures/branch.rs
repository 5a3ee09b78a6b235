//! A branch of solutions, divided where its stability changes.

use super::SpecialPoint;

/// A branch of solutions.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Branch {
    /// Name in the legend, for example `K_{d} = 10`; branches of one name share a colour. Without a name a
    /// branch is black and not in the legend.
    pub name: Option<String>,
    /// Parameter along the branch.
    pub x: Vec<f64>,
    /// Measure, as many values.
    pub y: Vec<f64>,
    /// Whether each point is stable, as many values; points beyond its end are drawn as stable, so it may be
    /// empty where stability is not known.
    pub stable: Vec<bool>,
    /// Special points of the branch.
    pub special: Vec<SpecialPoint>,
}

/// A part of a branch of one stability.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Part {
    pub stable: bool,
    pub points: Vec<[f64; 2]>,
}

/// Divides a branch where its stability changes. Neighbouring parts share the point of the change.
pub(super) fn parts(branch: &Branch) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let flags = branch.stable.iter().copied().chain(std::iter::repeat(true));
    let points: Vec<([f64; 2], bool)> = branch
        .x
        .iter()
        .zip(&branch.y)
        .zip(flags)
        .map(|((x, y), stable)| ([*x, *y], stable))
        .collect();
    let Some(&(first, stable)) = points.first() else {
        return parts;
    };
    let mut part = Part {
        stable,
        points: vec![first],
    };
    for (index, pair) in points.windows(2).enumerate() {
        let ((from, before), (to, after)) = (pair[0], pair[1]);
        let mut between = branch.special.iter().filter(|point| point.after == Some(index));
        if before == after {
            part.points.extend(between.map(|point| [point.x, point.y]));
        } else {
            let change = between
                .find(|point| point.kind.changes_stability())
                .map_or([(from[0] + to[0]) / 2.0, (from[1] + to[1]) / 2.0], |point| {
                    [point.x, point.y]
                });
            part.points.push(change);
            parts.push(std::mem::replace(
                &mut part,
                Part {
                    stable: after,
                    points: vec![change],
                },
            ));
        }
        part.points.push(to);
    }
    parts.push(part);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::SpecialKind;

    fn branch(stable: &[bool]) -> Branch {
        let x: Vec<f64> = (0..stable.len()).map(|i| i as f64).collect();
        Branch {
            y: x.iter().map(|x| 2.0 * x).collect(),
            x,
            stable: stable.to_vec(),
            ..Branch::default()
        }
    }

    #[test]
    fn a_branch_changes_style_half_way_between_points() {
        let parts = parts(&branch(&[true, true, false, true]));
        assert_eq!(
            parts,
            [
                Part {
                    stable: true,
                    points: vec![[0.0, 0.0], [1.0, 2.0], [1.5, 3.0]]
                },
                Part {
                    stable: false,
                    points: vec![[1.5, 3.0], [2.0, 4.0], [2.5, 5.0]]
                },
                Part {
                    stable: true,
                    points: vec![[2.5, 5.0], [3.0, 6.0]]
                },
            ]
        );
    }

    #[test]
    fn a_branch_changes_style_at_the_special_point() {
        let mut branch = branch(&[true, false]);
        let at = |x, y, kind| SpecialPoint {
            x,
            y,
            kind,
            after: Some(0),
        };
        branch.special = vec![
            at(0.2, 0.3, SpecialKind::Grazing),
            at(1.25, 1.0, SpecialKind::Fold),
        ];
        let parts = parts(&branch);
        assert_eq!(parts[0].points, [[0.0, 0.0], [1.25, 1.0]]);
        assert_eq!(parts[1].points, [[1.25, 1.0], [1.0, 2.0]]);
    }

    #[test]
    fn a_curve_passes_through_special_points_that_change_nothing() {
        let mut branch = branch(&[true, true]);
        branch.special = vec![SpecialPoint {
            x: 0.4,
            y: 0.9,
            kind: SpecialKind::Grazing,
            after: Some(0),
        }];
        assert_eq!(parts(&branch)[0].points, [[0.0, 0.0], [0.4, 0.9], [1.0, 2.0]]);
    }

    #[test]
    fn empty_branches_have_no_parts() {
        assert!(parts(&Branch::default()).is_empty());
        assert_eq!(parts(&branch(&[false])).len(), 1);
        let unknown = Branch {
            stable: vec![],
            ..branch(&[false, false])
        };
        assert!(parts(&unknown)[0].stable);
    }
}

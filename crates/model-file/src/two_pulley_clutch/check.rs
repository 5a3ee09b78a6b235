//! Which parameters make a sound model, and which make a surprising one (theory 02 §13).

use super::{DampingRatio, Parameters, TwoPulleyClutch};
use crate::error::Issue;
use crate::reader::Read;
use crate::scalar::{Bound, Scalars, join};

impl TwoPulleyClutch {
    pub(crate) fn check(&self) -> Read<()> {
        let (path, damping_ratio) = self.damping_ratio();
        match &self.parameters {
            Parameters::Dimensionless(parameters) => parameters.check_scalars("dimensionless")?,
            Parameters::Physical(parameters) => parameters.check_scalars("physical")?,
        }
        check_damping_ratio(&path, damping_ratio)?;
        if let Some(smoothing) = &self.smoothing {
            smoothing.check("smoothing")?;
        }
        Ok(())
    }

    /// Key and message of everything that may surprise.
    pub(crate) fn cautions(&self) -> Vec<(String, String)> {
        let mut cautions = Vec::new();
        let (path, damping_ratio) = self.damping_ratio();
        let ratios = damping_ratio.of_modes();
        if ratios.iter().any(|ratio| *ratio >= 0.2) {
            cautions.push((
                path.clone(),
                "a damping ratio of 0.2 or more makes the multiple-scales solution unreliable".to_owned(),
            ));
        }
        if ratios.contains(&0.0) {
            cautions.push((
                path,
                "without damping, motions need not settle to a steady state".to_owned(),
            ));
        }
        if let Some(ratio) = self.frequency_ratio()
            && (ratio - ratio.round()).abs() <= 0.02
        {
            cautions.push((
                self.table().to_owned(),
                format!(
                    "the natural frequencies of the engaged system are near an internal resonance (ratio {ratio:.4}): the \
                     multiple-scales solution of the first mode is not valid"
                ),
            ));
        }
        let amplitude = match &self.parameters {
            Parameters::Dimensionless(parameters) => parameters.crank_amplitude,
            Parameters::Physical(parameters) => parameters.crank_amplitude,
        };
        if amplitude == 0.0 {
            cautions.push((
                join(self.table(), "crank_amplitude"),
                "the crank does not vibrate: only the static state is found".to_owned(),
            ));
        }
        if let Some(smoothing) = &self.smoothing {
            let deflection = self.static_deflection();
            if smoothing.width > 0.2 * deflection {
                cautions.push((
                    "smoothing.width".to_owned(),
                    format!(
                        "the width {} is more than a fifth of the static clutch deflection {deflection:.6}: the smooth \
                         law differs visibly from the clutch",
                        smoothing.width
                    ),
                ));
            }
            if let Some(caution) = smoothing.caution() {
                cautions.push(("smoothing.kind".to_owned(), caution.to_owned()));
            }
        }
        cautions
    }

    /// Key of the table with the parameters.
    fn table(&self) -> &'static str {
        match &self.parameters {
            Parameters::Dimensionless(_) => "dimensionless",
            Parameters::Physical(_) => "physical",
        }
    }

    fn damping_ratio(&self) -> (String, DampingRatio) {
        let ratio = match &self.parameters {
            Parameters::Dimensionless(parameters) => parameters.damping_ratio,
            Parameters::Physical(parameters) => parameters.damping_ratio,
        };
        (join(self.table(), "damping_ratio"), ratio)
    }
}

fn check_damping_ratio(path: &str, ratio: DampingRatio) -> Read<()> {
    let check = |path: &str, value: f64| match Bound::NotNegative.complaint(value) {
        Some((message, help)) => Err(Issue::wrong_value(path, message)
            .with_number(value)
            .with_help(help)),
        None => Ok(()),
    };
    match ratio {
        DampingRatio::Common(value) => check(path, value),
        DampingRatio::Each(values) => {
            check(&join(path, "0"), values[0])?;
            check(&join(path, "1"), values[1])
        }
    }
}

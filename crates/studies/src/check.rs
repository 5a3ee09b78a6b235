//! `check`: is the model sound, where does it rest, how does it vibrate, and when do its elements begin to switch.

use crate::modes::{ModeRow, mode_rows};
use crate::separation::{Separation, separations};
use crate::{Header, Method, Ratios, Signal, Study, StudyError, Subject, static_equilibrium};
use serde::Serialize;
use slackside_mechanics::System;
use slackside_model_file::Model;

/// The question.
#[derive(Debug, Clone)]
pub struct Check {
    /// The model.
    pub subject: Subject,
    /// Frequency of the load in the user's unit, for matrices that depend on it.
    pub frequency: Option<f64>,
}

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct CheckDocument {
    /// Head.
    #[serde(flatten)]
    pub header: Header,
    /// Kind of the model.
    pub kind: &'static str,
    /// Rest under the constant load; absent if there is no such state.
    pub equilibrium: Option<Equilibrium>,
    /// Modes, engaged ones first.
    pub modes: Vec<ModeRow>,
    /// When each element leaves the regime that it has at rest, from the linear response (theory 02 §1.9).
    pub separation: Vec<Separation>,
    /// The preload above which the clutch never separates; for the two-pulley clutch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub critical_preload: Option<f64>,
}

/// Rest under the constant load.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Equilibrium {
    /// Coordinates.
    pub coordinates: Ratios,
    /// Elements.
    pub elements: Vec<ElementAtRest>,
}

/// An element at rest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElementAtRest {
    /// Name.
    pub element: String,
    /// Kind of its law.
    pub law: &'static str,
    /// Displacement of its port: the static wind-up of a clutch.
    pub displacement: f64,
    /// Its force.
    pub force: f64,
    /// Its regime; absent for a smooth law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub regime: Option<&'static str>,
}

impl Study for Check {
    type Job = ();
    type Rows = CheckDocument;
    type Document = CheckDocument;

    fn plan(&self) -> Result<Vec<()>, StudyError> {
        Ok(vec![()])
    }

    fn run(&self, (): &(), _: &Signal) -> Result<CheckDocument, StudyError> {
        let system = self.subject.system()?;
        let frequency = match self.subject.angular_frequency(self.frequency) {
            Err(_) if self.frequency.is_none() && !system.is_frequency_dependent() => 1.0,
            other => other?,
        };
        let mut header = self.subject.header("check", Method::new("linear analysis"));
        let rest = match static_equilibrium(&system, frequency) {
            Ok(rest) => Some(rest),
            Err(StudyError::NoAnswer(reason)) => {
                header.warnings.push(reason);
                None
            }
            Err(other) => return Err(other),
        };
        let separation = match &rest {
            Some(rest) => separations(&self.subject, &system, rest)?,
            None => Vec::new(),
        };
        let critical_preload = match (&self.subject.model, separation.first()) {
            (Model::TwoPulleyClutch(_), Some(first)) => first
                .critical_load_factor
                .map(|factor| factor * self.preload(&system)),
            _ => None,
        };
        Ok(CheckDocument {
            header,
            kind: self.subject.model.kind(),
            equilibrium: rest.map(|rest| equilibrium(&system, &rest)),
            modes: mode_rows(&self.subject, &system, frequency)?,
            separation,
            critical_preload,
        })
    }

    fn collect(
        &self,
        rows: Vec<Option<Result<CheckDocument, StudyError>>>,
        _: bool,
    ) -> Result<CheckDocument, StudyError> {
        rows.into_iter()
            .flatten()
            .next()
            .unwrap_or(Err(StudyError::Interrupted))
    }
}

impl Check {
    /// The constant torque on the pulley.
    fn preload(&self, system: &System) -> f64 {
        system.forcing.constant.first().copied().unwrap_or(f64::NAN)
    }
}

fn equilibrium(system: &System, rest: &[f64]) -> Equilibrium {
    let elements = system.elements.iter().map(|element| {
        let displacement = element.port.project(rest);
        ElementAtRest {
            element: element.name.clone(),
            law: element.law.kind(),
            displacement,
            force: element.law.response(displacement, 0.0).force,
            regime: crate::separation::regime_at(element, displacement).map(|(_, regime)| regime.name),
        }
    });
    Equilibrium {
        elements: elements.collect(),
        coordinates: Ratios(
            system
                .coordinates
                .iter()
                .cloned()
                .zip(rest.iter().copied())
                .collect(),
        ),
    }
}

//! Which matrices, elements and forces make a sound system.

use super::{Element, Excitation, MechanicalSystem, NumberMap, Output};
use crate::error::Issue;
use crate::names::{check_item_names, check_name};
use crate::reader::Read;
use crate::scalar::{Bound, Scalars, join};
use slackside_linalg::is_positive_definite;

impl MechanicalSystem {
    pub(crate) fn check(&self) -> Read<()> {
        check_names("coordinates", "coordinate", &self.coordinates)?;
        self.check_matrices()?;
        self.check_mass()?;
        check_item_names("element", self.elements.iter().map(|element| &*element.name))?;
        for element in &self.elements {
            element.check()?;
        }
        self.excitation.check()?;
        check_item_names("output", self.outputs.iter().map(|output| &*output.name))?;
        for output in &self.outputs {
            output.check()?;
        }
        self.check_measure_names()
    }

    /// Coordinates, elements and outputs are all measures of the results, which go by name.
    fn check_measure_names(&self) -> Read<()> {
        let coordinates = self.coordinates.iter().map(String::as_str);
        let elements = self.elements.iter().map(|element| &*element.name);
        let taken: Vec<&str> = coordinates.chain(elements).collect();
        let element_paths = (0..self.elements.len()).map(|index| format!("element.{index}.name"));
        for (index, path) in element_paths.enumerate() {
            check_name(
                &path,
                &self.elements[index].name,
                &taken[..self.coordinates.len()],
            )?;
        }
        for (index, output) in self.outputs.iter().enumerate() {
            check_name(&format!("output.{index}.name"), &output.name, &taken)?;
        }
        Ok(())
    }

    /// Checks what a change of the number at `path` can break: everything but the factorisation of an unchanged
    /// mass matrix, whose cost grows with the cube of its size.
    pub(crate) fn check_after_change(&mut self, path: &str) -> Read<()> {
        let (table, rest) = crate::scalar::split_first(path);
        match table {
            "mass" => {
                // Mass is symmetric, so a change of one entry means a change of both.
                self.mass.mirror(rest);
                self.mass.check_finite("mass")?;
                self.check_mass()
            }
            "element" => self.elements.iter().try_for_each(Element::check),
            "excitation" => self.excitation.check(),
            "output" => self.outputs.iter().try_for_each(Output::check),
            _ => self.check_matrices(),
        }
    }

    fn check_matrices(&self) -> Read<()> {
        self.mass.check_finite("mass")?;
        self.damping.check_finite("damping")?;
        self.stiffness.check_finite("stiffness")?;
        if let Some(matrix) = &self.damping_linear_in_frequency {
            matrix.check_finite("damping_linear_in_frequency")?;
        }
        if let Some(matrix) = &self.stiffness_quadratic_in_frequency {
            matrix.check_finite("stiffness_quadratic_in_frequency")?;
        }
        Ok(())
    }

    fn check_mass(&self) -> Read<()> {
        let mass = self.mass.as_matrix();
        for row in 0..mass.rows() {
            for column in 0..row {
                let (below, above) = (mass[(row, column)], mass[(column, row)]);
                if below != above {
                    return Err(Issue::wrong_value(
                        format!("mass.{row}.{column}"),
                        format!("the mass matrix is not symmetric: mass.{column}.{row} is {above:?}"),
                    )
                    .with_number(below)
                    .with_help("give both entries the same value"));
                }
            }
        }
        if let Some(row) = (0..mass.rows()).find(|row| mass[(*row, *row)] <= 0.0) {
            return Err(Issue::wrong_value(
                format!("mass.{row}.{row}"),
                format!(
                    "the mass matrix is not positive definite: coordinate \"{}\" has no positive mass",
                    self.coordinates.get(row).map_or("", String::as_str)
                ),
            )
            .with_number(mass[(row, row)])
            .with_help("give every coordinate a positive mass"));
        }
        if !is_positive_definite(mass) {
            return Err(Issue::wrong_value(
                "mass",
                "the mass matrix is not positive definite: some motion has no positive kinetic energy",
            )
            .with_help("reduce the entries off the diagonal or increase those on it"));
        }
        Ok(())
    }

    /// Key and message of everything that may surprise.
    pub(crate) fn cautions(&self) -> Vec<(String, String)> {
        let mut cautions = Vec::new();
        for element in &self.elements {
            if let Some(caution) = element.law.smoothing().and_then(|smoothing| smoothing.caution()) {
                cautions.push((
                    format!("element.{}.law.smoothing.kind", element.name),
                    caution.to_owned(),
                ));
            }
        }
        let mut amplitudes = self
            .excitation
            .harmonics
            .iter()
            .flat_map(|harmonic| harmonic.cos.values().chain(harmonic.sin.values()));
        if amplitudes.all(|amplitude| *amplitude == 0.0) {
            cautions.push((
                "excitation".to_owned(),
                "no force varies in time: there is nothing to respond to".to_owned(),
            ));
        }
        cautions
    }
}

impl Element {
    fn check(&self) -> Read<()> {
        let path = join("element", &self.name);
        let port = join(&path, "port");
        check_finite(&self.port, &port)?;
        if self.port.values().all(|factor| *factor == 0.0) {
            return Err(Issue::wrong_value(
                port,
                "the port is zero: the element is not connected to anything",
            )
            .with_help("name at least one coordinate, as in `port = { pulley = 1.0 }`"));
        }
        self.law.check(&join(&path, "law"))
    }
}

impl Excitation {
    fn check(&self) -> Read<()> {
        if let Some(frequency) = self.frequency
            && let Some((message, help)) = Bound::Positive.complaint(frequency)
        {
            return Err(Issue::wrong_value("excitation.frequency", message)
                .with_number(frequency)
                .with_help(help));
        }
        check_finite(&self.constant, "excitation.constant")?;
        for (index, harmonic) in self.harmonics.iter().enumerate() {
            let path = format!("excitation.harmonics.{index}");
            check_finite(&harmonic.cos, &join(&path, "cos"))?;
            check_finite(&harmonic.sin, &join(&path, "sin"))?;
            let earlier = &self.harmonics[..index];
            if let Some(first) = earlier.iter().position(|other| other.order == harmonic.order) {
                return Err(Issue::wrong_value(
                    join(&path, "order"),
                    format!("the order is already given by excitation.harmonics.{first}"),
                )
                .with_value(harmonic.order)
                .with_help("put both into one item"));
            }
        }
        Ok(())
    }
}

impl Output {
    fn check(&self) -> Read<()> {
        let path = join("output", &self.name);
        check_finite(&self.displacement, &join(&path, "displacement"))?;
        check_finite(&self.velocity, &join(&path, "velocity"))?;
        check_finite(&self.force, &join(&path, "force"))?;
        if let Some(constant) = self.constant
            && let Some((message, help)) = Bound::Any.complaint(constant)
        {
            return Err(Issue::wrong_value(join(&path, "constant"), message)
                .with_number(constant)
                .with_help(help));
        }
        for (index, harmonic) in self.harmonics.iter().enumerate() {
            let path = format!("{path}.harmonics.{index}");
            harmonic.check_scalars(&path)?;
        }
        Ok(())
    }
}

fn check_finite(map: &NumberMap, path: &str) -> Read<()> {
    match map.iter().find(|(_, value)| !value.is_finite()) {
        Some((name, value)) => Err(Issue::wrong_value(join(path, name), "is not a finite number")
            .with_number(*value)
            .with_help("give a finite number")),
        None => Ok(()),
    }
}

/// Checks the names of coordinates, which stand in a list of texts.
fn check_names(path: &str, what: &str, names: &[String]) -> Read<()> {
    if names.is_empty() {
        return Err(Issue::wrong_value(path, format!("there is no {what}"))
            .with_value("[]")
            .with_help("name at least one"));
    }
    for (index, name) in names.iter().enumerate() {
        check_name(&join(path, &index.to_string()), name, &names[..index])?;
    }
    Ok(())
}

//! From the file's matrices and tables to the equations of motion.

use slackside_mechanics::{Element, Forcing, Harmonic, Output, Port, System};

use super::{MechanicalSystem, NumberMap};
use crate::reader::Read;

impl MechanicalSystem {
    /// The system, with these measures: every coordinate and its rate (`pulley`, `pulley.rate`), the force and the
    /// deflection of every element (`clutch`, `clutch.deflection`), and the outputs of the file.
    pub(crate) fn system(&self) -> Read<System> {
        let mut forcing = Forcing {
            constant: self.column(&self.excitation.constant),
            harmonics: Vec::new(),
        };
        for harmonic in &self.excitation.harmonics {
            forcing.add_harmonic(Harmonic {
                order: to_order(harmonic.order),
                cosine: self.column(&harmonic.cos),
                sine: self.column(&harmonic.sin),
            });
        }
        let elements = self
            .elements
            .iter()
            .map(|element| {
                Ok(Element {
                    name: element.name.clone(),
                    port: Port::new(self.terms(&element.port)),
                    law: element.law.law(&format!("element.{}.law", element.name))?,
                })
            })
            .collect::<Read<Vec<_>>>()?;
        Ok(System {
            coordinates: self.coordinates.clone(),
            mass: self.mass.as_matrix().clone(),
            damping: self.damping.as_matrix().clone(),
            stiffness: self.stiffness.as_matrix().clone(),
            damping_linear_in_frequency: self
                .damping_linear_in_frequency
                .as_ref()
                .map(|matrix| matrix.as_matrix().clone()),
            stiffness_quadratic_in_frequency: self
                .stiffness_quadratic_in_frequency
                .as_ref()
                .map(|matrix| matrix.as_matrix().clone()),
            forcing,
            outputs: self.measures(),
            elements,
        })
    }

    fn measures(&self) -> Vec<Output> {
        let mut outputs = Vec::new();
        for (index, name) in self.coordinates.iter().enumerate() {
            outputs.push(Output::coordinate(name, index));
            outputs.push(Output {
                name: format!("{name}.rate"),
                velocity: vec![(index, 1.0)],
                ..Output::default()
            });
        }
        for (index, element) in self.elements.iter().enumerate() {
            outputs.push(Output::element_force(&element.name, index));
            outputs.push(Output {
                name: format!("{}.deflection", element.name),
                displacement: self.terms(&element.port),
                ..Output::default()
            });
        }
        for output in &self.outputs {
            let element_index =
                |name: &String| self.elements.iter().position(|element| element.name == *name);
            outputs.push(Output {
                name: output.name.clone(),
                displacement: self.terms(&output.displacement),
                velocity: self.terms(&output.velocity),
                force: output
                    .force
                    .iter()
                    .filter_map(|(name, factor)| Some((element_index(name)?, *factor)))
                    .collect(),
                constant: output.constant.unwrap_or_default(),
                harmonics: (output.harmonics.iter())
                    .map(|harmonic| (to_order(harmonic.order), harmonic.cos, harmonic.sin))
                    .collect(),
            });
        }
        outputs
    }

    /// Index and factor of the coordinates of a map.
    fn terms(&self, map: &NumberMap) -> Vec<(usize, f64)> {
        let factor_of = |name| map.get(name).copied();
        self.coordinates
            .iter()
            .enumerate()
            .filter_map(|(index, name)| Some((index, factor_of(name)?)))
            .collect()
    }

    /// The map as a vector with one entry for each coordinate.
    fn column(&self, map: &NumberMap) -> Vec<f64> {
        self.coordinates
            .iter()
            .map(|name| map.get(name).copied().unwrap_or(0.0))
            .collect()
    }
}

/// An order beyond the range of usize could not be computed with on such a machine anyway.
fn to_order(order: u32) -> usize {
    usize::try_from(order).unwrap_or(usize::MAX)
}

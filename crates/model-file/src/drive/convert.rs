//! From the file to the drive that the mechanics compute with.

use std::f64::consts::TAU;

use glam::DVec2;
use slackside_belt_drive::drive as mechanics;
use slackside_belt_drive::layout::{LayoutError, infer_rotation};

use super::{
    Amount, ArcStretch, BearingDrag, BeltModel, Condition, Contact, Coupling, CouplingKind, Direction, Drive,
    DryFriction, Excitation, Friction, Guide, Installation, Length, Load, ModalDamping, ModesPerSpan, Mount,
    Order, Pulley, Rotation, Section, SectionProperties, Size, SpanEnds, SpeedOf, StopContact, Tensioner,
};
use crate::error::{Issue, ModelFileError};
use crate::reader::Read;

/// Effective friction if the file gives none; a caution says so.
const ASSUMED_FRICTION: f64 = 1.0;

impl Drive {
    /// The drive for the mechanics, in SI units, with the senses of rotation.
    ///
    /// Without `operating.rotation` the driver turns in the sense in which the belt can follow the pulleys in the order of
    /// the file, with the arms at their reference.
    ///
    /// # Errors
    /// [`crate::Problem::WrongValue`] if no belt can run round the pulleys in this way: which pulleys or spans are in the
    /// way, and what would help. [`crate::Document::model`] reports the same with the line of the file. With
    /// `operating.rotation` given, a layout that is impossible in both senses is left to the mechanics, because the arms
    /// may come to rest elsewhere than at their reference.
    pub fn belt_drive(&self) -> Result<mechanics::Drive, ModelFileError> {
        self.convert().map_err(|issue| issue.without_source())
    }

    /// What shakes the driver.
    pub fn excitation(&self) -> mechanics::Excitation {
        let convert = |orders: &[Order]| orders.iter().map(Order::convert).collect();
        let Excitation { motion, torque } = &self.excitation;
        if !motion.is_empty() {
            mechanics::Excitation::Motion(convert(motion))
        } else if !torque.is_empty() {
            mechanics::Excitation::Torque(convert(torque))
        } else {
            mechanics::Excitation::None
        }
    }

    /// The conditions of the file, without the one as installed.
    pub fn conditions(&self) -> Vec<mechanics::Condition> {
        self.conditions.iter().map(Condition::convert).collect()
    }

    pub(crate) fn convert(&self) -> Read<mechanics::Drive> {
        let driver = self
            .pulleys
            .iter()
            .position(|pulley| pulley.driver)
            .ok_or_else(|| Issue::wrong_value("pulley", "no pulley drives the belt"))?;
        // Sense of the pulleys inside the loop for a driver that turns counter-clockwise.
        let inside = match self.pulleys[driver].contact {
            Contact::Ribs => mechanics::Sense::CounterClockwise,
            Contact::Back => mechanics::Sense::Clockwise,
        };
        let drive = mechanics::Drive {
            belt: self.belt(),
            pulleys: self
                .pulleys
                .iter()
                .map(|pulley| self.pulley(pulley, inside))
                .collect::<Read<_>>()?,
            tensioners: self
                .tensioners
                .iter()
                .map(|tensioner| self.tensioner(tensioner))
                .collect(),
            driver,
            installation: self.installation(),
        };
        let sense = self.sense_of_driver(&drive)?;
        Ok(if drive.pulleys[driver].sense == sense {
            drive
        } else {
            drive.reversed()
        })
    }

    /// The sense of the file, or else the one in which a belt can follow the pulleys.
    fn sense_of_driver(&self, drive: &mechanics::Drive) -> Read<mechanics::Sense> {
        let possible = infer_rotation(drive);
        let given = match self.operating.rotation {
            Some(Rotation::CounterClockwise) => mechanics::Sense::CounterClockwise,
            Some(Rotation::Clockwise) => mechanics::Sense::Clockwise,
            None => {
                return possible.map_err(|error| Issue::wrong_value(key_of(&error), error.to_string()));
            }
        };
        // Pulleys that no belt can follow with the arms at their reference may be possible where the arms come to rest.
        if possible.is_ok_and(|sense| sense != given) {
            return Err(Issue::wrong_value(
                "operating.rotation",
                "in this sense the belt does not meet the pulleys in the order of the file, in the other it does",
            )
            .with_help("turn the sense, or list the pulleys in the opposite order"));
        }
        Ok(given)
    }

    /// Stiffness and mass of the whole belt.
    fn section(&self) -> SectionProperties {
        match &self.belt.section {
            Section::Whole(section) => section.clone(),
            Section::PerRib(section) => {
                let ribs = f64::from(self.belt.ribs.unwrap_or(1));
                SectionProperties {
                    axial_stiffness: ribs * section.per_rib.axial_stiffness,
                    bending_stiffness: ribs * section.per_rib.bending_stiffness,
                    mass_per_length: ribs * section.per_rib.mass_per_length,
                }
            }
        }
    }

    fn belt(&self) -> mechanics::Belt {
        let belt = &self.belt;
        let section = self.section();
        mechanics::Belt {
            model: match belt.model {
                BeltModel::Spring => mechanics::BeltModel::Spring,
                BeltModel::String => mechanics::BeltModel::String,
                BeltModel::Beam => mechanics::BeltModel::Beam,
            },
            axial_stiffness: section.axial_stiffness,
            bending_stiffness: section.bending_stiffness,
            mass_per_length: section.mass_per_length,
            span_ends: match belt.span_ends {
                SpanEnds::Tangent => mechanics::SpanEnds::Tangent,
                SpanEnds::Contact => mechanics::SpanEnds::Contact,
            },
            arc_stretch: match belt.arc_stretch {
                ArcStretch::None => mechanics::ArcStretch::None,
                ArcStretch::Mean => mechanics::ArcStretch::Mean,
                ArcStretch::Entry => mechanics::ArcStretch::Entry,
            },
            terms: match &belt.modes_per_span {
                ModesPerSpan::Common(terms) => vec![*terms; self.pulleys.len()],
                ModesPerSpan::Each(terms) => terms.clone(),
            },
            static_correction: belt.static_correction,
            arc_participation: belt.arc_participation,
            wrapped_inertia: belt.wrapped_inertia,
            damping: self.damping(),
            thermal_expansion: belt.thermal_expansion,
        }
    }

    fn damping(&self) -> mechanics::BeltDamping {
        let damping = &self.belt.damping;
        let rayleigh = damping.rayleigh.clone().unwrap_or_default();
        let loss_factor = damping.loss_factor.filter(|value| *value > 0.0);
        mechanics::BeltDamping {
            span_dashpot: damping.span_dashpot,
            loss_factor: loss_factor
                .zip(self.loss_factor_frequency())
                .map(|(value, reference_frequency)| mechanics::LossFactor {
                    value,
                    reference_frequency,
                }),
            external: damping.external,
            drag: damping.drag,
            internal_bending: damping.internal_bending,
            rayleigh_mass: rayleigh.mass,
            rayleigh_stiffness: rayleigh.stiffness,
            modal: damping.modal.as_ref().map(|modal| match modal {
                ModalDamping::Common(ratio) => mechanics::ModalDamping::Common(*ratio),
                ModalDamping::Each(ratios) => mechanics::ModalDamping::Each(ratios.clone()),
            }),
        }
    }

    fn pulley(&self, pulley: &Pulley, inside: mechanics::Sense) -> Read<mechanics::Pulley> {
        let (mount, drag_reacts_on_arm) = self.mount(pulley)?;
        Ok(mechanics::Pulley {
            name: pulley.name.clone(),
            radius: self.pitch_radius(pulley),
            sense: match pulley.contact {
                Contact::Ribs => inside,
                Contact::Back => inside.reversed(),
            },
            mount,
            inertia: pulley.inertia,
            mass: match &pulley.mount {
                Mount::Fixed(_) => 0.0,
                Mount::Carried(carried) => carried.mass,
            },
            load: pulley.load.convert(),
            bearing_damping: pulley.bearing_damping,
            drag_reacts_on_arm,
            friction: pulley.friction.unwrap_or_else(|| self.friction(pulley.contact)),
            coupling: pulley
                .coupling
                .as_ref()
                .map_or(mechanics::Coupling::NONE, Coupling::convert),
            accessory_damping: pulley
                .coupling
                .as_ref()
                .map_or(0.0, |coupling| coupling.accessory_damping),
        })
    }

    /// Radius of the cord line (theory 04 §1).
    fn pitch_radius(&self, pulley: &Pulley) -> f64 {
        let of_belt = match pulley.contact {
            Contact::Ribs => self.belt.cord_offset_ribs,
            Contact::Back => self.belt.cord_offset_back,
        };
        let offset = pulley.cord_offset.or(of_belt).unwrap_or_default();
        match pulley.size {
            Size::Radius(radius) => radius,
            Size::OutsideDiameter(diameter) | Size::EffectiveDiameter(diameter) => 0.5 * diameter + offset,
        }
    }

    /// Effective friction of a side of the belt (theory 04 §2.7).
    fn friction(&self, contact: Contact) -> f64 {
        let back = |coefficient| self.belt.back_friction.unwrap_or(coefficient);
        match (&self.belt.friction, contact) {
            (Some(Friction::Effective(effective)), Contact::Ribs) => *effective,
            (Some(Friction::Effective(effective)), Contact::Back) => back(*effective),
            (Some(Friction::Grooved(friction)), Contact::Ribs) => {
                friction.coefficient / (0.5 * friction.groove_angle).sin()
            }
            (Some(Friction::Grooved(friction)), Contact::Back) => back(friction.coefficient),
            (None, Contact::Ribs) => ASSUMED_FRICTION,
            (None, Contact::Back) => back(ASSUMED_FRICTION),
        }
    }

    /// What holds a pulley, and whether its drag reacts on a tensioner.
    fn mount(&self, pulley: &Pulley) -> Read<(mechanics::Mount, bool)> {
        let carried = match &pulley.mount {
            Mount::Fixed(fixed) => return Ok((mechanics::Mount::Fixed(fixed.center.into()), false)),
            Mount::Carried(carried) => carried,
        };
        let found = self
            .tensioners
            .iter()
            .enumerate()
            .find(|(_, tensioner)| tensioner.name == carried.arm);
        let Some((index, tensioner)) = found else {
            return Err(Issue::wrong_value(
                format!("pulley.{}.arm", pulley.name),
                "there is no such tensioner",
            ));
        };
        let place = match &tensioner.guide {
            Guide::Rotary(rotary) => {
                let length = carried.arm_length.or(rotary.arm_length).unwrap_or_default();
                match carried.arm_angle_offset {
                    // The exact vector: a rotation by zero would leave a rounding error behind.
                    None => DVec2::new(length, 0.0),
                    Some(offset) => length * DVec2::from_angle(offset),
                }
            }
            Guide::Linear(linear) => {
                DVec2::from(linear.point) + carried.offset.map_or(DVec2::ZERO, DVec2::from)
            }
        };
        Ok((
            mechanics::Mount::Carried {
                tensioner: index,
                place,
            },
            tensioner.bearing_drag == BearingDrag::Arm,
        ))
    }

    fn tensioner(&self, tensioner: &Tensioner) -> mechanics::Tensioner {
        let (guide, inertia) = match &tensioner.guide {
            Guide::Rotary(rotary) => (
                mechanics::Guide::Rotary {
                    pivot: rotary.pivot.into(),
                },
                rotary.inertia,
            ),
            Guide::Linear(linear) => (
                mechanics::Guide::Linear {
                    direction: match linear.direction {
                        Direction::Angle(angle) => DVec2::from_angle(angle),
                        // Checks leave no vector without a direction.
                        Direction::Vector(vector) => DVec2::from(vector).normalize_or_zero(),
                    },
                },
                linear.mass,
            ),
        };
        let spring = tensioner.spring.clone().unwrap_or_default();
        let follows = matches!(self.belt.length, Length::Installation(Installation::Tension(_)));
        mechanics::Tensioner {
            name: tensioner.name.clone(),
            guide,
            reference: tensioner.guide.reference().1,
            spring_rate: spring.rate,
            spring_preload: spring.preload.filter(|_| !follows),
            inertia,
            damping: tensioner.damping,
            stops: tensioner.stops,
            locked: tensioner.locked,
            friction: tensioner.friction.as_ref().map(DryFriction::convert),
            one_way_damping: tensioner.one_way_damping,
            stop_contact: tensioner.stop_contact.as_ref().map(StopContact::convert),
            pulley_contacts: self.pulley_contacts(tensioner),
        }
    }

    fn installation(&self) -> mechanics::Installation {
        match &self.belt.length {
            Length::NaturalLength(length) => mechanics::Installation::NaturalLength(*length),
            Length::EffectiveLength(length) => {
                // L_pitch = L_eff + 2πb (theory 04 §1), stretched by the tension of the measurement.
                let pitch_length = length + TAU * self.belt.cord_offset_ribs.unwrap_or_default();
                let strain = self.belt.measuring_tension.unwrap_or_default() / self.section().axial_stiffness;
                mechanics::Installation::NaturalLength(pitch_length / (1.0 + strain))
            }
            Length::Installation(Installation::Tension(state)) => {
                mechanics::Installation::Tension(state.tension)
            }
            Length::Installation(Installation::OperatingPosition(_)) => {
                mechanics::Installation::OperatingPosition {
                    driver_speed: self.operating.speed,
                }
            }
        }
    }
}

/// Key of the pulley that is in the way.
fn key_of(error: &LayoutError) -> String {
    match error {
        LayoutError::Overlap { second: name, .. }
        | LayoutError::NoTangent { to: name, .. }
        | LayoutError::NotTouched { pulley: name, .. }
        | LayoutError::SpanHitsPulley { pulley: name, .. } => format!("pulley.{name}"),
        LayoutError::Turning { .. } | LayoutError::SpansCross { .. } => "pulley".to_owned(),
    }
}

impl Load {
    fn convert(&self) -> mechanics::Load {
        match self {
            Self::Torque(torque) => mechanics::Load::Torque(*torque),
            Self::Power(load) => mechanics::Load::Power(load.power),
            Self::Table(table) => mechanics::Load::Table(mechanics::LoadTable {
                speed: table.speed.clone(),
                value: table
                    .torque
                    .as_ref()
                    .or(table.power.as_ref())
                    .cloned()
                    .unwrap_or_default(),
                is_power: table.torque.is_none(),
                over_driver: table.over == SpeedOf::Driver,
            }),
        }
    }
}

impl Coupling {
    fn convert(&self) -> mechanics::Coupling {
        let accessory_inertia = self.accessory_inertia;
        let flexible = mechanics::Flexible {
            accessory_inertia,
            // Checks leave no flexible kind without a stiffness.
            stiffness: self.stiffness.unwrap_or_default(),
            damping: self.damping.unwrap_or_default(),
        };
        match self.kind {
            CouplingKind::Rigid => mechanics::Coupling::Rigid { accessory_inertia },
            CouplingKind::OneWay => mechanics::Coupling::OneWay { accessory_inertia },
            CouplingKind::WrapSpring => mechanics::Coupling::WrapSpring(flexible),
            CouplingKind::Isolator => mechanics::Coupling::Isolator(flexible),
            CouplingKind::Decoupler => mechanics::Coupling::Decoupler {
                spring: flexible,
                preload: self.preload.unwrap_or_default(),
            },
        }
    }
}

impl Order {
    fn convert(&self) -> mechanics::OrderAmplitude {
        let over_speed = |amount: &Amount| match amount {
            Amount::Constant(value) => vec![*value; self.speed.len()],
            Amount::Each(values) => values.clone(),
        };
        let constant = |amount: &Amount| amount.values().first().copied().unwrap_or_default();
        let table = if self.speed.is_empty() {
            mechanics::OrderTable::Constant {
                amplitude: constant(&self.amplitude),
                phase: constant(&self.phase),
            }
        } else {
            mechanics::OrderTable::OverSpeed {
                speed: self.speed.clone(),
                amplitude: over_speed(&self.amplitude),
                phase: over_speed(&self.phase),
            }
        };
        mechanics::OrderAmplitude {
            order: self.order,
            table,
        }
    }
}

impl Condition {
    fn convert(&self) -> mechanics::Condition {
        mechanics::Condition {
            name: self.name.clone(),
            temperature_change: self.temperature_change,
            length_change: self.length_change,
            elongation: self.elongation,
            structure_expansion: self.structure_expansion,
            spring_factor: self.spring_factor,
        }
    }
}

//! Why there is no steady creep.

/// Failure of a creep computation. Tensions in newtons, torques in newton metres; messages in degrees for angles.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CreepError {
    /// A pulley on which the belt slips along the whole contact.
    #[error(
        "the belt slips all round pulley \"{pulley}\": it would need a slip arc of {:.0}° and the wrap is {:.0}°; raise the tension, the wrap or the friction, or lower the load",
        slip_arc.to_degrees(), wrap.to_degrees()
    )]
    GrossSlip {
        /// The pulley.
        pulley: String,
        /// Slip arc that the tensions ask for, rad; infinite without friction.
        slip_arc: f64,
        /// The wrap, rad.
        wrap: f64,
    },
    /// A span without effective tension.
    #[error(
        "span {span} has no effective tension ({effective_tension:.1} N), so nothing presses the belt onto the pulleys; raise the installation tension or lower the load or the speed"
    )]
    Slack {
        /// The span, `from-to`.
        span: String,
        /// `T = P − m c²`, N.
        effective_tension: f64,
    },
    /// A torque that two pulleys cannot transmit.
    #[error(
        "the drive transmits at most {largest:.4} N·m at this speed, {torque:.4} N·m are asked for; then the belt slips all round pulley {pulley}"
    )]
    TorqueTooLarge {
        /// Torque asked for, N·m.
        torque: f64,
        /// Largest torque, N·m.
        largest: f64,
        /// Pulley that slips, 1 or 2.
        pulley: usize,
    },
    /// A torque by which the driven pulley would drive.
    #[error("the torque on the driven pulley must not be negative ({torque} N·m); exchange the pulleys")]
    NegativeTorque {
        /// Torque asked for, N·m.
        torque: f64,
    },
    /// Pulleys that overlap.
    #[error("the pulleys overlap: their centres are {distance} m apart, their radii add up to {radii} m")]
    Overlap {
        /// Distance of the centres, m.
        distance: f64,
        /// Sum of the radii, m.
        radii: f64,
    },
    /// A belt that is too long to be tight at this speed.
    #[error(
        "a belt of natural length {natural_length} m is slack at this speed; it would have to be shorter than {longest} m"
    )]
    TooLong {
        /// Natural length, m.
        natural_length: f64,
        /// Natural length at which the effective tension vanishes, m.
        longest: f64,
    },
    /// A belt so short that no tension stretches it round the pulleys.
    #[error("no finite tension stretches a belt of natural length {natural_length} m round these pulleys")]
    TooShort {
        /// Natural length, m.
        natural_length: f64,
    },
}

//! Why a layout is not possible, in the engineer's words.

/// A layout that no belt can follow (theory 04 §1.5). Lengths in metres, angles in radians; messages in mm and degrees.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LayoutError {
    /// Two pulleys share space.
    #[error(
        "pulleys \"{first}\" and \"{second}\" overlap: their centres are {:.1} mm apart, their pitch radii add up to {:.1} mm; move one away or make it smaller",
        1e3 * distance, 1e3 * radii
    )]
    Overlap {
        /// One pulley.
        first: String,
        /// The other.
        second: String,
        /// Distance of the centres.
        distance: f64,
        /// Sum of the radii.
        radii: f64,
    },
    /// Two successive pulleys have no common tangent.
    #[error(
        "no belt leads from \"{from}\" to \"{to}\": their centres are {:.1} mm apart, and a common tangent needs more than {:.1} mm; move them apart, or check which side of the belt touches them",
        1e3 * distance, 1e3 * needed
    )]
    NoTangent {
        /// Where the span would start.
        from: String,
        /// Where it would end.
        to: String,
        /// Distance of the centres.
        distance: f64,
        /// Least distance.
        needed: f64,
    },
    /// The path does not close as a simple loop.
    #[error(
        "the belt does not run round in a simple loop: it turns {:.0}° in all instead of {:.0}°; list the pulleys in the order in which the belt meets them, and check `contact` (ribs: inside the loop, back: outside) of {}",
        turning.to_degrees(), expected.to_degrees(), suspects.join(", ")
    )]
    Turning {
        /// `Σ σ_j φ_j`.
        turning: f64,
        /// What it must be.
        expected: f64,
        /// Pulleys with the largest wraps, the likely culprits, quoted.
        suspects: Vec<String>,
    },
    /// A pulley that the belt misses.
    #[error(
        "the belt does not touch \"{pulley}\": straight on from \"{before}\" to \"{after}\" it passes the pulley by; move the pulley towards the belt, or let the other side of the belt touch it"
    )]
    NotTouched {
        /// The pulley.
        pulley: String,
        /// The one before.
        before: String,
        /// The one after.
        after: String,
    },
    /// A span that runs through a pulley that is not at its ends.
    #[error(
        "span {span} runs through pulley \"{pulley}\": it passes its centre at {:.1} mm, its pitch radius is {:.1} mm; move the pulley, or list it between the two",
        1e3 * distance, 1e3 * radius
    )]
    SpanHitsPulley {
        /// The span, `from-to`.
        span: String,
        /// The pulley.
        pulley: String,
        /// Distance of its centre from the span.
        distance: f64,
        /// Its radius.
        radius: f64,
    },
    /// Two spans that cross.
    #[error(
        "spans {first} and {second} cross; check the order of the pulleys and `contact` of those between them"
    )]
    SpansCross {
        /// One span.
        first: String,
        /// The other.
        second: String,
    },
}

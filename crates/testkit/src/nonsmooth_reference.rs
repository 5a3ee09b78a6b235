//! Assembly of the systems of `nonsmooth_three_pulley.json` (theory 05 §12): a drive of thirteen coordinates with an overrunning
//! clutch at its accessory or dry friction at its tensioner arm.

use crate::{number, numbers, reference};
use serde_json::Value;
use slackside_linalg::Matrix;
use slackside_mechanics::{Element, Forcing, Harmonic, Law, OperatingPoint, Output, Port, System};
use std::sync::Arc;

const ARM: usize = 1;
const PULLEY: usize = 2;
const ACCESSORY: usize = 3;

/// Which of the two systems of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Machine {
    /// The accessory on a clutch, thirteen coordinates; with a key `Q` there is friction at the arm as well.
    Clutch,
    /// The accessory locked to its pulley and friction at the arm, twelve coordinates.
    Friction,
}

impl Machine {
    /// The system that the input of a periodic orbit or transient names.
    pub fn of(input: &Value) -> Self {
        match input["system"].as_str() {
            Some("clutch") => Self::Clutch,
            Some("friction") => Self::Friction,
            other => panic!("unknown system {other:?}"),
        }
    }
}

/// Where an element acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Between the accessory pulley (+1) and the accessory (−1).
    Clutch,
    /// At the tensioner arm (+1).
    Arm,
}

/// The whole reference file.
pub fn nonsmooth_reference() -> Value {
    reference("nonsmooth_three_pulley.json")
}

/// The system of an entry's `input`, with elements `clutch` and `arm` as the machine has them and their laws as `law` says.
/// Outputs are the coordinates, their rates (`<coordinate>_rate`), the element forces (`<element>_torque`) and the dynamic span
/// tensions (`tension_1` to `tension_3`).
pub fn operating_point(
    file: &Value,
    machine: Machine,
    input: &Value,
    law: &dyn Fn(Place, &Value) -> Arc<dyn Law>,
) -> OperatingPoint {
    let (params, model) = (&file["params"], &file["model"]);
    let value = |key: &str, default: f64| input.get(key).map_or(default, number);
    let frequency = number(&input["W"]);
    let load = value("Ml", 0.0);
    let load_follows = input["load_dependent_tension"].as_bool() == Some(true);
    let tension_load = if load_follows {
        load
    } else {
        number(&params["load_nominal"])
    };
    let belt_speed_ratio = number(&model["crank_radius"]) / number(&model["firing_order"]);

    let mut mass = matrix(&model["M"]);
    let mut damping = matrix(&model["C"]);
    let mut stiffness = matrix(&model["K0"]);
    stiffness.add_scaled(tension_load, &matrix(&model["KM"]));
    if let Some(alpha) = input.get("alpha") {
        mass[(ACCESSORY, ACCESSORY)] = number(alpha) * mass[(PULLEY, PULLEY)];
    }
    if let Some(coefficient) = input.get("c_accessory") {
        damping[(ACCESSORY, ACCESSORY)] = number(coefficient);
    }
    let gyroscopic = matrix(&model["G1"]).scaled(belt_speed_ratio);
    let centripetal = matrix(&model["K2"]).scaled(belt_speed_ratio * belt_speed_ratio);

    let reduce = |full: &[f64]| match machine {
        Machine::Clutch => full.to_vec(),
        Machine::Friction => merged(full),
    };
    let reduce_matrix = |full: &Matrix| match machine {
        Machine::Clutch => full.clone(),
        Machine::Friction => {
            let rows: Vec<Vec<f64>> = (0..full.rows()).map(|i| merged(full.row(i))).collect();
            let half = Matrix::from_rows(&rows).expect("rows of one length").transpose();
            let rows: Vec<Vec<f64>> = (0..half.rows()).map(|i| merged(half.row(i))).collect();
            Matrix::from_rows(&rows).expect("rows of one length").transpose()
        }
    };
    let names = file["coordinates"].as_array().expect("a list").iter();
    let mut coordinates: Vec<String> = names.map(|name| name.as_str().expect("a name").into()).collect();
    if machine == Machine::Friction {
        coordinates.remove(ACCESSORY);
    }
    let n = coordinates.len();

    let mut elements = Vec::new();
    if machine == Machine::Clutch {
        elements.push(Element {
            name: "clutch".into(),
            port: Port::new([(PULLEY, 1.0), (ACCESSORY, -1.0)]),
            law: law(Place::Clutch, input),
        });
    }
    if machine == Machine::Friction || input.get("Q").is_some() {
        elements.push(Element {
            name: "arm".into(),
            port: Port::new([(ARM, 1.0)]),
            law: law(Place::Arm, input),
        });
    }

    let mut forcing = Forcing::none(n);
    let biased = match machine {
        Machine::Clutch => load,
        Machine::Friction => value("bias", 0.0),
    };
    for (sum, b) in forcing.constant.iter_mut().zip(elements[0].port.dense(n)) {
        *sum = biased * b;
    }
    let (coupling, coupling_damping) = (numbers(&model["Kc"]), numbers(&model["Cc"]));
    let theta = crank_harmonics(file, input);
    for &(order, re, im) in &theta {
        // F_k = −(K_c + ikΩ C_c) Θ_k
        let omega = order as f64 * frequency;
        let parts = coupling.iter().zip(&coupling_damping);
        let (cosine, sine): (Vec<f64>, Vec<f64>) = parts
            .map(|(k, c)| (-(k * re - omega * c * im), k * im + omega * c * re))
            .unzip();
        forcing.add_harmonic(Harmonic {
            order,
            cosine: reduce(&cosine),
            sine: reduce(&sine),
        });
    }

    let mut outputs = Vec::new();
    for (index, name) in coordinates.iter().enumerate() {
        outputs.push(Output::coordinate(name.clone(), index));
    }
    for (index, name) in coordinates.iter().enumerate() {
        outputs.push(Output {
            name: format!("{name}_rate"),
            velocity: vec![(index, 1.0)],
            ..Output::default()
        });
    }
    for (index, element) in elements.iter().enumerate() {
        outputs.push(Output::element_force(format!("{}_torque", element.name), index));
    }
    let sparse = |row: &Value| {
        let row = reduce(&numbers(row));
        row.into_iter().enumerate().filter(|(_, v)| *v != 0.0).collect()
    };
    let (prescribed, prescribed_rate) = (numbers(&model["tqc"]), numbers(&model["tvc"]));
    for span in 0..prescribed.len() {
        let harmonics = theta.iter().map(|&(order, re, im)| {
            let (a, b) = (prescribed[span], order as f64 * frequency * prescribed_rate[span]);
            (order, a * re - b * im, -(a * im + b * re))
        });
        outputs.push(Output {
            name: format!("tension_{}", span + 1),
            displacement: sparse(&model["Tq"][span]),
            velocity: sparse(&model["Tv"][span]),
            harmonics: harmonics.collect(),
            ..Output::default()
        });
    }

    let system = System {
        coordinates,
        mass: reduce_matrix(&mass),
        damping: reduce_matrix(&damping),
        stiffness: reduce_matrix(&stiffness),
        damping_linear_in_frequency: Some(reduce_matrix(&gyroscopic)),
        stiffness_quadratic_in_frequency: Some(reduce_matrix(&centripetal)),
        forcing,
        elements,
        outputs,
    };
    system.check().expect("a sound system");
    OperatingPoint {
        system: Arc::new(system),
        frequency,
    }
}

/// Harmonics of the crank's rotation as order, real and imaginary part (rad).
fn crank_harmonics(file: &Value, input: &Value) -> Vec<(usize, f64, f64)> {
    let given = input.get("theta").unwrap_or(&file["defaults"]["theta"]);
    let entry = |entry: &Value| {
        let order = entry[0].as_u64().expect("an order") as usize;
        (order, number(&entry[1]), number(&entry[2]))
    };
    given.as_array().expect("a list").iter().map(entry).collect()
}

/// A row with the accessory added to its pulley and taken out.
fn merged(full: &[f64]) -> Vec<f64> {
    let mut result = full.to_vec();
    result[PULLEY] += result[ACCESSORY];
    result.remove(ACCESSORY);
    result
}

fn matrix(value: &Value) -> Matrix {
    let rows: Vec<Vec<f64>> = value.as_array().expect("a list").iter().map(numbers).collect();
    Matrix::from_rows(&rows).expect("rows of one length")
}

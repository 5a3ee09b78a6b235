//! The cases of `nonsmooth_three_pulley.json` as model files of kind `mechanical-system`, as somebody would write them who has
//! the program and the reference, but not this repository.

use crate::{number, numbers};
use serde_json::Value;
use std::fmt::Write;

const ARM: usize = 1;
const PULLEY: usize = 2;
const ACCESSORY: usize = 3;

type Rows = Vec<Vec<f64>>;

/// The model file of an entry's `input`, at its frequency: with elements `clutch` and `arm` as far as the input has them, and
/// outputs `tension_1` to `tension_3` (dynamic span tensions). Forces of the crank's rotation are those at this frequency.
pub fn model_file(file: &Value, input: &Value) -> String {
    let model = &file["model"];
    let value = |key: &str, default: f64| input.get(key).map_or(default, number);
    let frequency = number(&input["W"]);
    let load = value("Ml", 0.0);
    let locked = input["system"] == "friction";
    let tension_load = match input["load_dependent_tension"].as_bool() {
        Some(true) => load,
        _ => number(&file["params"]["load_nominal"]),
    };
    // Belt speed per unit of frequency.
    let ratio = number(&model["crank_radius"]) / number(&model["firing_order"]);

    let (mut mass, mut damping) = (rows(&model["M"]), rows(&model["C"]));
    if let Some(alpha) = input.get("alpha") {
        mass[ACCESSORY][ACCESSORY] = number(alpha) * mass[PULLEY][PULLEY];
    }
    if let Some(coefficient) = input.get("c_accessory") {
        damping[ACCESSORY][ACCESSORY] = number(coefficient);
    }
    let stiffness = sum(&rows(&model["K0"]), tension_load, &rows(&model["KM"]));
    let gyroscopic = scaled(ratio, &rows(&model["G1"]));
    let centripetal = scaled(ratio * ratio, &rows(&model["K2"]));

    let mut coordinates: Vec<&str> = texts(&file["coordinates"]);
    if locked {
        coordinates.remove(ACCESSORY);
    }
    let square = |matrix: &Rows| {
        if locked {
            without_accessory(&transposed(&without_accessory(&transposed(matrix))))
        } else {
            matrix.clone()
        }
    };
    let row = |full: &[f64]| if locked { merged(full) } else { full.to_vec() };

    let mut text = format!("kind = \"mechanical-system\"\ncoordinates = {:?}\n", coordinates);
    for (key, matrix) in [
        ("mass", &mass),
        ("damping", &damping),
        ("stiffness", &stiffness),
        ("damping_linear_in_frequency", &gyroscopic),
        ("stiffness_quadratic_in_frequency", &centripetal),
    ] {
        line(&mut text, key, &format!("{:?}", square(matrix)));
    }
    if !locked {
        element(
            &mut text,
            "clutch",
            &format!(
                "{{ {} = 1.0, {} = -1.0 }}",
                coordinates[PULLEY], coordinates[ACCESSORY]
            ),
            &clutch_law(input),
        );
    }
    if locked || input.get("Q").is_some() {
        element(
            &mut text,
            "arm_friction",
            &format!("{{ {} = 1.0 }}", coordinates[ARM]),
            &friction_law(input),
        );
    }
    let map = |values: &[f64]| {
        let named = coordinates.iter().zip(values);
        let entries: Vec<String> = named
            .filter(|(_, value)| **value != 0.0)
            .map(|(name, value)| format!("{name} = {value:?}"))
            .collect();
        format!("{{ {} }}", entries.join(", "))
    };
    text += "[excitation]\n";
    line(&mut text, "frequency", &format!("{frequency:?}"));
    let mut constant = vec![0.0; coordinates.len()];
    if locked {
        constant[ARM] = value("bias", 0.0);
    } else {
        constant[PULLEY] = load;
        constant[ACCESSORY] = -load;
    }
    line(&mut text, "constant", &map(&constant));
    let (coupling, coupling_rate) = (numbers(&model["Kc"]), numbers(&model["Cc"]));
    let theta = crank_harmonics(file, input);
    for &(order, re, im) in &theta {
        let omega = order as f64 * frequency;
        // F = −(K_c + iω C_c)(re + i im); Re F e^{iωt} = Re F · cos − Im F · sin.
        let pairs = || coupling.iter().zip(&coupling_rate);
        let cos: Vec<f64> = pairs().map(|(k, c)| -(k * re - omega * c * im)).collect();
        let sin: Vec<f64> = pairs().map(|(k, c)| k * im + omega * c * re).collect();
        text += "[[excitation.harmonics]]\n";
        line(&mut text, "order", &order.to_string());
        line(&mut text, "cos", &map(&row(&cos)));
        line(&mut text, "sin", &map(&row(&sin)));
    }
    let (tension, tension_rate) = (rows(&model["Tq"]), rows(&model["Tv"]));
    let (prescribed, prescribed_rate) = (numbers(&model["tqc"]), numbers(&model["tvc"]));
    for span in 0..tension.len() {
        text += "[[output]]\n";
        line(&mut text, "name", &format!("\"tension_{}\"", span + 1));
        line(&mut text, "displacement", &map(&row(&tension[span])));
        line(&mut text, "velocity", &map(&row(&tension_rate[span])));
        for &(order, re, im) in &theta {
            let (a, b) = (prescribed[span], order as f64 * frequency * prescribed_rate[span]);
            text += "[[output.harmonics]]\n";
            line(&mut text, "order", &order.to_string());
            line(&mut text, "cos", &format!("{:?}", a * re - b * im));
            line(&mut text, "sin", &format!("{:?}", -(a * im + b * re)));
        }
    }
    text
}

/// The clutch's law as the file's key `law` has it.
fn clutch_law(input: &Value) -> String {
    let clutch = &input["clutch"];
    match clutch["type"].as_str() {
        None | Some("velocity") => "{ kind = \"one-way\" }".to_owned(),
        Some("decoupler") => format!(
            "{{ kind = \"decoupler\", stiffness = {:?} }}",
            number(&clutch["k"])
        ),
        Some("viscous") => format!(
            "{{ kind = \"one-way-damper\", damping = {:?} }}",
            number(&clutch["c"])
        ),
        Some(other) => panic!("unknown clutch {other}"),
    }
}

fn friction_law(input: &Value) -> String {
    let law = &input["law"];
    let of = |key: &str| number(&law[key]);
    match law["type"].as_str() {
        None | Some("coulomb") => {
            let ratio = input.get("static_ratio").map_or(1.0, number);
            let torque = number(&input["Q"]);
            format!("{{ kind = \"coulomb\", torque = {torque:?}, static_ratio = {ratio:?} }}")
        }
        Some("asymmetric") => format!(
            "{{ kind = \"coulomb\", negative_torque = {:?}, positive_torque = {:?} }}",
            of("Q_minus"),
            of("Q_plus")
        ),
        Some("one_way_damper") => format!("{{ kind = \"one-way-damper\", damping = {:?} }}", of("c")),
        Some(other) => panic!("unknown law {other}"),
    }
}

/// Harmonics of the crank's rotation: order, real and imaginary part (rad).
fn crank_harmonics(file: &Value, input: &Value) -> Vec<(u64, f64, f64)> {
    let given = input.get("theta").unwrap_or(&file["defaults"]["theta"]);
    let harmonics = given.as_array().expect("a list").iter();
    harmonics
        .map(|h| (h[0].as_u64().expect("an order"), number(&h[1]), number(&h[2])))
        .collect()
}

fn line(text: &mut String, key: &str, value: &str) {
    writeln!(text, "{key} = {value}").expect("writing to a string");
}

fn element(text: &mut String, name: &str, port: &str, law: &str) {
    *text += "[[element]]\n";
    line(text, "name", &format!("\"{name}\""));
    line(text, "port", port);
    line(text, "law", law);
}

fn texts(value: &Value) -> Vec<&str> {
    let items = value.as_array().expect("a list").iter();
    items.map(|item| item.as_str().expect("a text")).collect()
}

fn rows(value: &Value) -> Rows {
    value.as_array().expect("a list").iter().map(numbers).collect()
}

/// `a + factor · b`.
fn sum(a: &Rows, factor: f64, b: &Rows) -> Rows {
    let add = |(x, y): (&f64, &f64)| x + factor * y;
    let pairs = a.iter().zip(b);
    pairs.map(|(x, y)| x.iter().zip(y).map(add).collect()).collect()
}

fn scaled(factor: f64, a: &Rows) -> Rows {
    let times = |row: &Vec<f64>| row.iter().map(|x| factor * x).collect();
    a.iter().map(times).collect()
}

fn transposed(matrix: &Rows) -> Rows {
    let columns = matrix.first().map_or(0, Vec::len);
    (0..columns)
        .map(|j| matrix.iter().map(|row| row[j]).collect())
        .collect()
}

/// Rows with that of the accessory added to that of its pulley.
fn without_accessory(matrix: &Rows) -> Rows {
    transposed(&transposed(matrix).iter().map(|row| merged(row)).collect())
}

fn merged(full: &[f64]) -> Vec<f64> {
    let mut result = full.to_vec();
    result[PULLEY] += result[ACCESSORY];
    result.remove(ACCESSORY);
    result
}

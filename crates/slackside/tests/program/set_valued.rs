//! `response` on systems with clutches and dry friction, and on drives: certificate, branches, optimum, families of words.
//! References: `validation/reference/nonsmooth_three_pulley.json`.

use super::{close, document, example, failure, slackside};
use serde_json::Value;
use slackside_testkit::nonsmooth_file::model_file;
use slackside_testkit::nonsmooth_reference::nonsmooth_reference;
use slackside_testkit::number;

/// An arm with dry friction beside a driven pulley; `law` is the friction's.
fn arm(law: &str) -> String {
    format!(
        r#"kind = "mechanical-system"
coordinates = ["arm", "pulley"]
mass      = [[1.0, 0.0], [0.0, 0.5]]
damping   = [[0.04, -0.02], [-0.02, 0.05]]
stiffness = [[2.0, -1.0], [-1.0, 4.0]]

[[element]]
name = "friction"
port = {{ arm = 1.0 }}
law  = {law}

[excitation]
frequency = 1.2
harmonics = [ {{ order = 1, cos = {{ pulley = 1.0 }} }} ]
"#
    )
}

#[test]
fn response_finds_the_motions_of_the_reference_and_certifies_them() {
    let file = nonsmooth_reference();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.toml");
    let mut tried = 0;
    for entry in file["periodic"].as_array().unwrap() {
        let input = &entry["input"];
        // The reference's frequency is that of the file; a narrow range around it holds it as a value asked for.
        let frequency = input["W"].as_f64().unwrap_or(0.0);
        if input.get("clutch").is_some() || input.get("law").is_some() || frequency == 0.0 {
            continue;
        }
        std::fs::write(&path, model_file(&file, input)).unwrap();
        let text = path.display().to_string();
        let unit = 1.0;
        let found = document(&["check", &text]);
        // Files may have units of their own: the frequency of the file is what `simulate` uses.
        let simulated = document(&["simulate", &text, "--periods", "1", "--samples", "0"]);
        assert!(found["units"]["frequency"].is_string());
        let at = simulated["frequency"].as_f64().unwrap() * unit;
        let over = format!("frequency={}:{}:{}", 0.99 * at, 1.01 * at, 0.01 * at);
        let found = document(&["response", &text, "--over", &over, "--at", &at.to_string()]);
        assert_eq!(found["method"]["name"], "periodic");
        let motion = &found["at"][0];
        let events = entry["events"].as_array().unwrap();
        assert_eq!(
            motion["events"].as_array().unwrap().len(),
            events.len(),
            "{input}"
        );
        for (event, expected) in motion["events"].as_array().unwrap().iter().zip(events) {
            close(&event["phase"], number(&expected["t_over_T"]), 1e-9, "event");
        }
        assert!(motion["energy"]["imbalance"].as_f64().unwrap() < 1e-10);
        tried += 1;
    }
    assert!(tried >= 5, "{tried} cases");
}

#[test]
fn dissipation_has_an_interior_optimum_and_locked_friction_dissipates_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    std::fs::write(&path, arm("{ kind = \"coulomb\", torque = 0.3 }")).unwrap();
    let text = path.display().to_string();
    let key = "element.friction.law.torque";
    let over = format!("{key}=0.005:0.5:0.005");
    let found = document(&["response", &text, "--over", &over, "--optimum"]);
    assert_eq!(found["uniqueness"][0]["unique"], true);
    assert!(
        found["warnings"].as_array().unwrap().is_empty(),
        "{}",
        found["warnings"]
    );
    let points = found["branches"][0]["points"].as_array().unwrap();
    assert_eq!(points.len(), 100);
    let dissipation = |point: &Value| number(&point["elements"]["friction"]["dissipation"]);
    let optimum = &found["optimum"][0];
    let largest = points.iter().map(dissipation).fold(0.0, f64::max);
    let best = number(&optimum["value"]);
    assert!(best >= largest && best < 1.001 * largest, "{best} {largest}");
    assert_eq!(optimum["at_end"], false);
    // Above the critical torque the arm stands still.
    let last = points.last().unwrap();
    close(&last["elements"]["friction"]["dissipation"], 0.0, 1e-12, "locked");
    close(&last["regimes"]["friction"]["stick"], 1.0, 1e-12, "locked");
    assert_eq!(last["stuck"][0], "friction");
    let (status, message) = failure(&[
        "response",
        &text,
        "--over",
        &format!("{key}=0.1:0.5:0.1"),
        "--optimum",
    ]);
    assert_eq!(status, 2);
    assert!(message.contains("at least 60"), "{message}");
}

#[test]
fn where_uniqueness_fails_all_passes_are_made_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.toml");
    std::fs::write(
        &path,
        arm("{ kind = \"coulomb\", torque = 0.3, static_ratio = 1.5 }"),
    )
    .unwrap();
    let text = path.display().to_string();
    let found = document(&["response", &text, "--over", "frequency=0.8:1.6:0.1"]);
    assert_eq!(found["uniqueness"][0]["no_jumps"], false);
    let warning = found["warnings"][0].as_str().unwrap();
    assert!(warning.contains("uniqueness not guaranteed"), "{warning}");
    assert!(warning.contains("going down"), "{warning}");
}

#[test]
fn designs_of_a_drive_are_compared() {
    let drive = example("drives/overrunning-alternator.toml");
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = slackside(&[
        "response",
        &drive,
        "--over",
        "speed=800:1200:200",
        "--for",
        "pulley.alternator.coupling.kind=rigid,one-way",
        "--set",
        "belt.modes_per_span=2",
        "--out",
        out.to_str().unwrap(),
    ]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("What each buys") && text.contains("one-way"),
        "{text}"
    );
    for name in [
        "designs.csv",
        "uniqueness.csv",
        "tensions.png",
        "arms.svg",
        "response.svg",
    ] {
        assert!(out.join(name).is_file(), "{name}");
    }
    let table = std::fs::read_to_string(out.join("branches.csv")).unwrap();
    let head = table.lines().next().unwrap();
    assert!(head.contains("for.pulley.alternator.coupling.kind"), "{head}");
    assert!(head.contains("coupling.alternator.overrunning"), "{head}");
}

#[test]
fn wrong_questions_are_told() {
    let drive = example("drives/overrunning-alternator.toml");
    for (extra, part) in [
        (
            vec!["--for", "pulley.alternator.coupling.kind=rigid,rigid"],
            "twice",
        ),
        (vec!["--for", "pulley.alternator.coupling.kind=loose"], "loose"),
        (vec!["--optimum", "arm.tensioner.mean"], "neither"),
        (vec!["--doublings", "1"], "--doublings"),
        (vec!["--optimum", "dissipation.arm"], "known are"),
    ] {
        let mut arguments = vec!["response", &drive, "--over", "speed=800:1200"];
        arguments.extend(extra);
        let (status, message) = failure(&arguments);
        assert_eq!(status, 2, "{message}");
        assert!(message.contains(part), "{message}");
    }
}

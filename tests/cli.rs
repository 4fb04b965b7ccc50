//! The command lines of `mask` and `compare`, tried as a new user would: bad input gives one line that names the
//! problem and what is legal, exit code 2, and leaves nothing behind; good input gives what was promised.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The built example. `cargo test` builds examples before it runs tests; `cargo test --test cli` alone does not.
fn example(name: &str) -> PathBuf {
    let mut folder = std::env::current_exe().expect("the test's own path");
    folder.pop();
    if folder.ends_with("deps") {
        folder.pop();
    }
    folder.join("examples").join(format!("{name}{}", std::env::consts::EXE_SUFFIX))
}

fn run(name: &str, folder: &Path, arguments: &[&str]) -> Output {
    Command::new(example(name)).current_dir(folder).args(arguments).output().expect("the example starts")
}

/// Runs in an empty folder, and checks the exit code, the one line, its words, and that the folder is as it was.
fn refused(name: &str, files: &[(&str, &str)], arguments: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (file, content) in files {
        std::fs::write(folder.path().join(file), content).expect("written");
    }
    let output = run(name, folder.path(), arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{name} {arguments:?}: {said}");
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 1, "{name} {arguments:?} said: {said}");
    for word in words {
        assert!(said.contains(word), "{name} {arguments:?} does not say {word:?}: {said}");
    }
    let left: Vec<_> =
        std::fs::read_dir(folder.path()).expect("readable").map(|entry| entry.expect("entry").file_name()).collect();
    assert_eq!(left.len(), files.len(), "{name} {arguments:?} left {left:?}");
}

/// A case of the built-in scene, with one field replaced.
fn case(field: &str, value: &str) -> String {
    let fields = [
        ("eye", "[0, 2, 18]"),
        ("target", "[0, 3, 0]"),
        ("up", "[0, 1, 0]"),
        ("fov_y_deg", "45"),
        ("near", "1"),
        ("far", "50"),
        ("travel", "[0.6, -0.8, 0.0]"),
        ("viewport", "[64, 48]"),
        ("shadow_distance", "50"),
        ("scene", "\"treeline\""),
    ];
    let get = |name: &str| {
        if name == field { value.to_owned() } else { fields.iter().find(|(n, _)| *n == name).unwrap().1.to_owned() }
    };
    format!(
        r#"{{"name": "test", "scene": {}, "camera": {{"eye": {}, "target": {}, "up": {}, "fov_y_deg": {}, "near": {}, "far": {}}},
            "light": {{"kind": "directional", "travel": {}}}, "viewport": {}, "shadow_distance": {}}}"#,
        get("scene"),
        get("eye"),
        get("target"),
        get("up"),
        get("fov_y_deg"),
        get("near"),
        get("far"),
        get("travel"),
        get("viewport"),
        get("shadow_distance"),
    )
}

const MASK: [&str; 10] =
    ["--case", "case.json", "--technique", "fsm", "--size", "64", "--out", "mask.png", "--backend", "cpu"];

/// `MASK` with one option's value replaced.
fn mask_with(option: &str, value: &'static str) -> Vec<&'static str> {
    let mut arguments = MASK.to_vec();
    let place = arguments.iter().position(|argument| *argument == option).expect("an option of MASK");
    arguments[place + 1] = value;
    arguments
}

#[test]
fn mask_refuses_bad_input() {
    let good = case("", "");
    refused("mask", &[], &MASK, &["case.json", "expected a case file"]);
    refused("mask", &[("case.json", "{")], &MASK, &["case.json", "expected an object"]);
    refused("mask", &[("case.json", &case("eye", "[NaN, 0, 0]"))], &MASK, &["case.json", "line 1"]);
    refused("mask", &[("case.json", &case("eye", "[1e999, 0, 0]"))], &MASK, &["case.json"]);
    refused("mask", &[("case.json", &case("near", "0"))], &MASK, &["camera.near", "0", "legal"]);
    refused("mask", &[("case.json", &case("far", "0.5"))], &MASK, &["camera.far", "0.5", "legal"]);
    refused("mask", &[("case.json", &case("fov_y_deg", "180"))], &MASK, &["camera.fov_y_deg", "180", "legal"]);
    refused("mask", &[("case.json", &case("travel", "[0, 0, 0]"))], &MASK, &["light.travel", "legal"]);
    refused("mask", &[("case.json", &case("viewport", "[0, 600]"))], &MASK, &["viewport", "legal"]);
    refused("mask", &[("case.json", &case("scene", "\"nowhere.glb\""))], &MASK, &["nowhere.glb", "legal"]);
    refused("mask", &[("case.json", &case("scene", "\"cut.glb\"")), ("cut.glb", "glTF\u{2}")], &MASK, &["cut.glb"]);
    refused("mask", &[("case.json", &good)], &mask_with("--technique", "nsm"), &["technique", "nsm", "ssm, fsm"]);
    refused("mask", &[("case.json", &good)], &mask_with("--size", "0"), &["size", "\"0\"", "1 to 16384"]);
    refused("mask", &[("case.json", &good)], &mask_with("--size", "16385"), &["size", "16385", "1 to 16384"]);
    refused(
        "mask",
        &[("case.json", &good)],
        &mask_with("--out", "no/such/folder/mask.png"),
        &["no/such/folder", "legal"],
    );
    refused("mask", &[("case.json", &good)], &mask_with("--out", "."), &["legal"]);
}

#[test]
fn compare_refuses_bad_input() {
    let cpu = ["--backend", "cpu"];
    let with = |arguments: &[&'static str]| [arguments, &cpu].concat();
    refused("compare", &[], &with(&["--scene", "nowhere.glb"]), &["nowhere.glb", "treeline, sparse-city", "legal"]);
    refused("compare", &[("cut.glb", "glTF\u{2}")], &with(&["--scene", "cut.glb"]), &["cut.glb"]);
    refused("compare", &[], &with(&["--case", "nowhere.json"]), &["nowhere.json", "expected a case file"]);
    refused("compare", &[("case.json", &case("eye", "[NaN, 0, 0]"))], &with(&["--case", "case.json"]), &["case.json"]);
    refused("compare", &[], &with(&["--technique", "ssm,nsm"]), &["technique", "nsm", "legal"]);
    refused("compare", &[], &with(&["--size", "512,0"]), &["size", "\"0\"", "1 to 16384"]);
    refused("compare", &[("file", "")], &with(&["--out", "file"]), &["file", "legal"]);
    refused("compare", &[("file", "")], &with(&["--out", "file/below"]), &["file/below", "legal"]);
}

#[test]
fn mask_writes_a_mask_and_its_times() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("case.json"), case("", "")).expect("written");
    let arguments = [&MASK[..], &["--timing", "mask.json"]].concat();
    let output = run("mask", folder.path(), &arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mask = image::open(folder.path().join("mask.png")).expect("a PNG");
    assert_eq!((mask.width(), mask.height(), mask.color()), (64, 48, image::ColorType::L8));
    let pixels = mask.into_luma8();
    // Sky at the top, and some shadow of trees further down.
    assert!(pixels.rows().next().expect("a row").any(|pixel| pixel.0[0] == 255));
    assert!(pixels.pixels().any(|pixel| pixel.0[0] == 0));
    let timing: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("mask.json")).expect("readable")).expect("JSON");
    for key in
        ["fit_ns", "casters_ms", "filter_ms", "receivers_ms", "total_ms", "bytes", "adapter", "backend", "left_out"]
    {
        assert!(!timing[key].is_null(), "{key} is missing");
    }
}

#[test]
fn help_teaches() {
    for (name, words) in
        [("mask", ["--case", "shadow_distance", "exit code 2"]), ("compare", ["--quick", "floor", "index.html"])]
    {
        let output = run(name, Path::new("."), &["--help"]);
        assert!(output.status.success());
        // Help is wrapped to the terminal.
        let said = String::from_utf8_lossy(&output.stdout).split_whitespace().collect::<Vec<_>>().join(" ");
        for word in words {
            assert!(said.contains(word), "{name} --help does not speak of {word}");
        }
    }
}

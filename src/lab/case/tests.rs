//! Case files, good and bad.

use glam::DVec4;
use serde_json::{Value, json};

use super::*;

fn document() -> Value {
    json!({
        "name": "street", "scene": "treeline", "note": "fields nobody knows are passed over",
        "camera": {"eye": [1, 2, 3], "target": [1, 2, -7], "up": [0, 5, 1], "fov_y_deg": 90, "near": 0.5, "far": 60},
        "light": {"kind": "directional", "travel": [0, -0.9995, 0]},
        "viewport": [800, 400], "shadow_distance": 60,
    })
}

fn load(document: &Value) -> Result<Case, CaseError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.json");
    std::fs::write(&path, document.to_string()).unwrap();
    Case::load(&path)
}

#[test]
fn a_case_is_read_and_its_light_normalised() {
    let case = load(&document()).unwrap();
    assert_eq!(case.light, CaseLight::Directional { travel: DVec3::NEG_Y });
    assert_eq!(case.viewport, [800, 400]);
    assert_eq!(case.scene_source(), Ok(SceneSource::BuiltIn("treeline".into())));
    let expected = [-2.0, 2.0, -1.0, 1.0];
    assert!(case.tangents().iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12));
}

#[test]
fn the_view_is_right_handed_and_looks_along_minus_z() {
    let world_from_view = load(&document()).unwrap().world_from_view();
    let expected = DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0));
    // `up` leans along the view: its part across the view is what counts.
    assert!(world_from_view.abs_diff_eq(expected, 1e-12));
    let ahead = world_from_view * DVec4::new(0.0, 0.0, -10.0, 1.0);
    assert!(ahead.abs_diff_eq(DVec4::new(1.0, 2.0, -7.0, 1.0), 1e-12));
    assert!((world_from_view.determinant() - 1.0).abs() < 1e-12);
}

#[test]
fn spot_and_point_lights_are_read() {
    let mut spot = document();
    spot["light"] =
        json!({"kind": "spot", "position": [0, 9, 0], "travel": [0, -1, 0], "half_angle_deg": 30, "range": 40});
    let light = CaseLight::Spot {
        position: DVec3::new(0.0, 9.0, 0.0),
        travel: DVec3::NEG_Y,
        half_angle_deg: 30.0,
        range: 40.0,
    };
    assert_eq!(load(&spot).unwrap().light, light);
    let mut point = document();
    point["light"] = json!({"kind": "point", "position": [0, 9, 0], "range": 40});
    assert_eq!(load(&point).unwrap().light, CaseLight::Point { position: DVec3::new(0.0, 9.0, 0.0), range: 40.0 });
}

/// Every field, one illegal value, and the line it gives.
#[test]
fn illegal_values_are_named() {
    let spot = |half_angle: f64, range: f64| json!({"kind": "spot", "position": [0, 9, 0], "travel": [0, -1, 0], "half_angle_deg": half_angle, "range": range});
    let table = [
        ("/camera/near", json!(0), "camera.near is 0; legal is a finite number greater than 0"),
        ("/camera/near", json!(60), "camera.far is 60; legal is a finite number greater than camera.near"),
        ("/camera/fov_y_deg", json!(180), "camera.fov_y_deg is 180; legal is more than 0 and less than 180 degrees"),
        ("/camera/target", json!([1, 2, 3]), "camera.target is [1, 2, 3]; legal is any point but camera.eye"),
        ("/camera/up", json!([0, 0, 4]), "camera.up is [0, 0, 4]; legal is a direction not parallel to target - eye"),
        ("/camera/up", json!([0, 0, 0]), "camera.up is [0, 0, 0]; legal is a direction not parallel to target - eye"),
        ("/viewport", json!([0, 600]), "viewport is [0, 600]; legal is 1 to 16384 pixels each"),
        ("/viewport", json!([800, 16385]), "viewport is [800, 16385]; legal is 1 to 16384 pixels each"),
        ("/shadow_distance", json!(-1), "shadow_distance is -1; legal is a finite number greater than 0"),
        (
            "/light/travel",
            json!([0, -1.1, 0]),
            "light.travel is [0, -1.1, 0]; legal is a vector of length 1 (to within 0.001)",
        ),
        ("/light", spot(90.0, 1.0), "light.half_angle_deg is 90; legal is more than 0 and less than 90 degrees"),
        ("/light", spot(30.0, 0.0), "light.range is 0; legal is a finite number greater than 0"),
    ];
    for (pointer, value, expected) in table {
        let mut document = document();
        *document.pointer_mut(pointer).unwrap() = value;
        assert_eq!(load(&document).unwrap_err().to_string(), expected);
    }
}

#[test]
fn numbers_that_are_none_are_refused_in_cases_made_in_code() {
    let good = load(&document()).unwrap();
    let spoil: [fn(&mut Case); 6] = [
        |case| case.camera.eye.x = f64::NAN,
        |case| case.camera.target.y = f64::INFINITY,
        |case| case.camera.far = f64::INFINITY,
        |case| case.camera.fov_y_deg = f64::NAN,
        |case| case.shadow_distance = f64::NAN,
        |case| case.light = CaseLight::Directional { travel: DVec3::NAN },
    ];
    for spoil in spoil {
        let mut case = good.clone();
        spoil(&mut case);
        assert!(matches!(case.check(), Err(CaseError::Field { .. })));
    }
}

#[test]
fn missing_and_unknown_parts_are_named_in_one_line() {
    let mut without_near = document();
    without_near["camera"].as_object_mut().unwrap().remove("near");
    let mut unknown_light = document();
    unknown_light["light"]["kind"] = json!("laser");
    for (document, expected) in [(without_near, "missing field `near`"), (unknown_light, "unknown variant `laser`")] {
        let text = load(&document).unwrap_err().to_string();
        assert!(text.contains(expected) && text.contains("case.json: ") && !text.contains('\n'), "{text}");
    }
    let missing = Case::load(Path::new("no/such/case.json")).unwrap_err();
    assert!(missing.to_string().starts_with("no/such/case.json: cannot be read"));
}

#[test]
fn scenes_are_sought_beside_the_case_and_one_folder_up() {
    let folder = tempfile::tempdir().unwrap();
    let cases = folder.path().join("cases");
    std::fs::create_dir_all(folder.path().join("scenes")).unwrap();
    std::fs::create_dir_all(&cases).unwrap();
    let mut document = document();
    document["scene"] = json!("scenes/a.glb");
    std::fs::write(cases.join("case.json"), document.to_string()).unwrap();
    let case = Case::load(&cases.join("case.json")).unwrap();
    let text = case.scene_source().unwrap_err().to_string();
    assert!(text.starts_with("scene is \"scenes/a.glb\"; legal is treeline"), "{text}");
    // One folder up it is found; beside the case it comes first.
    std::fs::write(folder.path().join("scenes/a.glb"), "").unwrap();
    assert_eq!(case.scene_source(), Ok(SceneSource::File(cases.join("../scenes/a.glb"))));
    std::fs::create_dir_all(cases.join("scenes")).unwrap();
    std::fs::write(cases.join("scenes/a.glb"), "").unwrap();
    assert_eq!(case.scene_source(), Ok(SceneSource::File(cases.join("scenes/a.glb"))));
}

//! Third-party glTF files load to what their descriptions say.

mod support;

use antumbra::lab::gltf;

/// File, triangles, and bounds to the digits that are known.
const SCENES: [(&str, usize, [f64; 3], [f64; 3]); 10] = [
    ("sauerbraten_zdm2", 58_772, [-33.9, -12.0, -29.3], [43.3, 24.0, 30.3]),
    ("shadow_columns", 16_646, [-814.8, -13.8, -59.4], [111.0, 18.8, 58.8]),
    ("japanese_temple", 29_696, [-10.0, 0.0, -10.0], [10.0, 37.4, 13.4]),
    ("sakura_tree", 29_704, [-4.8, 0.0, -5.1], [5.3, 8.9, 5.4]),
    ("alpha_tree_01_1", 646, [-2.9, 0.0, -3.1], [2.2, 7.4, 3.1]),
    ("truck_town", 30_477, [-1024.0, -4.6, -1024.0], [1024.0, 17.8, 1024.0]),
    ("delft_city_lod1", 36_267, [-262.0, -0.5, -164.0], [262.0, 16.9, 164.0]),
    ("terrain_jacksboro_dem", 275_772, [-14971.0, 236.0, -15859.0], [14971.0, 1076.0, 15859.0]),
    ("dutch_ship_medium", 69_162, [-10.3, -2.0, -3.5], [13.8, 22.7, 3.3]),
    ("teapot", 3_218, [-1.0, -0.5, -0.6], [1.0, 0.5, 0.6]),
];

/// Half a unit is lost where the description is rounded to whole units, a twentieth elsewhere.
const BOUNDS_TOLERANCE: f64 = 0.51;

#[test]
fn third_party_scenes_load() {
    let Some(scenes) = support::scenes() else { return };
    for (name, triangles, least, greatest) in SCENES {
        let scene = gltf::load(&scenes.join(name).with_extension("glb")).unwrap_or_else(|error| panic!("{error}"));
        let (found_least, found_greatest) = scene.bounds().expect("it has triangles");
        println!("{name}: {} triangles, {found_least} to {found_greatest}", scene.triangles.len());
        assert_eq!((scene.name.as_str(), scene.triangles.len()), (name, triangles));
        assert!(found_least.abs_diff_eq(least.into(), BOUNDS_TOLERANCE), "{name}: least corner {found_least}");
        assert!(found_greatest.abs_diff_eq(greatest.into(), BOUNDS_TOLERANCE), "{name}: greatest {found_greatest}");
        // The objects cover the triangles in order.
        let end = scene.objects.iter().fold(0, |end, object| {
            assert_eq!(object.start, end, "{name}");
            object.end
        });
        assert_eq!(end, triangles, "{name}");
        assert_eq!(scene.cutouts.len(), if name == "alpha_tree_01_1" { 2 } else { 0 }, "{name}");
    }
}

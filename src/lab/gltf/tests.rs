//! Small files made in memory.

use glam::DVec3;
use proptest::prelude::*;
use serde_json::{Value, json};

use super::*;

/// A file in the making: JSON, and one buffer in the binary chunk.
#[derive(Default)]
struct File {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    /// Appends bytes as a view and returns its index.
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()}));
        self.binary.extend_from_slice(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], component_type: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let mut accessor = json!({"bufferView": view, "componentType": component_type, "type": shape, "count": count});
        if shape == "VEC3" {
            (accessor["min"], accessor["max"]) = (json!([0, 0, 0]), json!([1, 1, 1]));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn floats(&mut self, values: &[f32], shape: &str, count: usize) -> usize {
        self.accessor(bytemuck::cast_slice(values), F32, shape, count)
    }

    /// Closes the file with the given members beside buffers, views and accessors.
    fn close(self, mut members: Value) -> Vec<u8> {
        members["asset"] = json!({"version": "2.0"});
        members["buffers"] = json!([{"byteLength": self.binary.len()}]);
        members["bufferViews"] = self.views.into();
        members["accessors"] = self.accessors.into();
        let glb = gltf::Glb {
            header: gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 },
            json: serde_json::to_vec(&members).unwrap().into(),
            bin: Some(self.binary.into()),
        };
        glb.to_vec().unwrap()
    }
}

const U8: u32 = 5121;
const U16: u32 = 5123;
const U32: u32 = 5125;
const F32: u32 = 5126;

/// Corners of a unit square, in the order of a strip.
const SQUARE: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];

/// One node, one mesh, one primitive.
fn one_mesh(primitive: &Value, node: &Value) -> Value {
    json!({"scenes": [{"nodes": [0]}], "nodes": [node], "meshes": [{"primitives": [primitive]}]})
}

/// A square drawn by indices of a given width, or none.
fn square(mode: u32, indices: Option<(u32, &[u8])>, node: &Value) -> Vec<u8> {
    let mut file = File::default();
    let positions = file.floats(&SQUARE, "VEC3", 4);
    let mut primitive = json!({"attributes": {"POSITION": positions}, "mode": mode});
    if let Some((component_type, bytes)) = indices {
        let size = match component_type {
            U8 => 1,
            U16 => 2,
            _ => 4,
        };
        primitive["indices"] = file.accessor(bytes, component_type, "SCALAR", bytes.len() / size).into();
    }
    file.close(one_mesh(&primitive, node))
}

fn problem(content: &[u8]) -> String {
    parse(content, None).unwrap_err().0
}

#[test]
fn indices_of_every_width_and_none_give_the_same_triangles() {
    let node = json!({"mesh": 0});
    let bytes8 = [0, 1, 2, 2, 1, 3];

    let bytes16: Vec<u8> = bytes8.iter().flat_map(|&i| u16::from(i).to_le_bytes()).collect();
    let bytes32: Vec<u8> = bytes8.iter().flat_map(|&i| u32::from(i).to_le_bytes()).collect();
    for indices in [(U8, &bytes8[..]), (U16, &bytes16), (U32, &bytes32)] {
        let scene = parse(&square(4, Some(indices), &node), None).unwrap();
        assert_eq!(scene.triangles, [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(scene.positions[3], DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(scene.objects.as_slice(), std::slice::from_ref(&(0..2)));
        assert!(scene.triangle_cutout.is_empty() && scene.uvs.is_empty());
    }
    let without = parse(&square(4, None, &node), None).unwrap();
    assert_eq!(without.triangles, [[0, 1, 2]], "the fourth position is left over");
}

#[test]
fn strips_and_fans_keep_their_winding_and_points_are_passed_over() {
    let node = json!({"mesh": 0});
    assert_eq!(parse(&square(5, None, &node), None).unwrap().triangles, [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(parse(&square(6, None, &node), None).unwrap().triangles, [[0, 1, 2], [0, 2, 3]]);
    assert!(problem(&square(0, None, &node)).contains("no triangles"));
}

#[test]
fn nested_nodes_transform_and_mirrored_ones_keep_their_front() {
    let mut file = File::default();
    let positions = file.floats(&SQUARE[..9], "VEC3", 3);
    let mirrored = json!({"mesh": 0, "scale": [-1, 1, 1]});
    let content = file.close(json!({
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [
            {"children": [1, 2], "translation": [10, 0, 0], "scale": [-2, 2, 2]},
            {"mesh": 0},
            mirrored,
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": positions}}]}],
    }));
    let scene = parse(&content, None).unwrap();
    assert_eq!(scene.objects, [0..1, 1..2]);
    let normal = |triangle: usize| {
        let [a, b, c] = scene.corners(triangle);
        (b - a).cross(c - a)
    };
    // Once mirrored: the square lies left of x = 10; its front must still look along +z. Mirrored twice: to the right.
    assert_eq!(scene.corners(0), [DVec3::new(10.0, 0.0, 0.0), DVec3::new(10.0, 2.0, 0.0), DVec3::new(8.0, 0.0, 0.0)]);
    assert_eq!(scene.corners(1)[1], DVec3::new(12.0, 0.0, 0.0));
    assert!(normal(0).z > 0.0 && normal(1).z > 0.0);
}

/// A card with a 2×1 alpha image: left half empty, right half full.
fn card(material: &Value, with_uvs: bool) -> Vec<u8> {
    let mut png = Vec::new();
    let pixels = image::RgbaImage::from_raw(2, 1, vec![9, 9, 9, 0, 9, 9, 9, 255]).unwrap();
    pixels.write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png).unwrap();
    let mut file = File::default();
    let mut attributes = json!({"POSITION": file.floats(&SQUARE, "VEC3", 4)});
    if with_uvs {
        attributes["TEXCOORD_0"] = file.floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0], "VEC2", 4).into();
    }
    let image = file.view(&png);
    let mut members = one_mesh(&json!({"attributes": attributes, "mode": 5, "material": 0}), &json!({"mesh": 0}));
    members["materials"] = json!([material]);
    members["textures"] = json!([{"source": 0}]);
    members["images"] = json!([{"bufferView": image, "mimeType": "image/png"}]);
    file.close(members)
}

#[test]
fn a_mask_card_has_holes_where_its_alpha_says() {
    let material = json!({
        "alphaMode": "MASK", "alphaCutoff": 0.25,
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.5]},
    });
    let scene = parse(&card(&material, true), None).unwrap();
    assert_eq!(scene.triangle_cutout, [0, 0]);
    let mask = &scene.cutouts[0];
    assert_eq!((mask.width, mask.height, &mask.alpha[..], mask.cutoff), (2, 1, &[0, 255][..], 0.5));
    // The middle of the first triangle's bottom edge is u = ½: alpha ½, just solid; left of it is a hole.
    assert!(scene.is_solid(0, DVec3::new(0.5, 0.5, 0.0)));
    assert!(!scene.is_solid(0, DVec3::new(0.6, 0.4, 0.0)));
    assert!(scene.is_solid(0, DVec3::new(0.3, 0.7, 0.0)));
}

#[test]
fn a_mask_without_image_is_decided_by_its_factor() {
    let with_alpha = |alpha: f32| {
        let factor = json!({"baseColorFactor": [1, 1, 1, alpha]});
        card(&json!({"alphaMode": "MASK", "pbrMetallicRoughness": factor}), false)
    };
    assert!(parse(&with_alpha(0.5), None).unwrap().cutouts.is_empty());
    assert!(problem(&with_alpha(0.49)).contains("no triangles"));
    let texture = json!({"baseColorTexture": {"index": 0}});
    let blended = parse(&card(&json!({"alphaMode": "BLEND", "pbrMetallicRoughness": texture}), true), None);
    assert!(blended.unwrap().cutouts.is_empty());
    let no_uvs = card(&json!({"alphaMode": "MASK", "pbrMetallicRoughness": texture}), false);
    assert!(problem(&no_uvs).contains("no TEXCOORD_0"));
}

#[test]
fn what_a_file_does_not_hold_is_an_error() {
    let node = json!({"mesh": 0});
    assert!(problem(&square(4, Some((U8, &[0, 1, 4])), &node)).contains("index 4 is out of range; legal is 0..4"));
    // Positions that are not numbers, in the file or after the transform.
    let mut file = File::default();
    let positions = file.floats(&[f32::NAN; 9], "VEC3", 3);
    let content = file.close(one_mesh(&json!({"attributes": {"POSITION": positions}}), &node));
    assert!(problem(&content).contains("must be finite"));
    // An accessor longer than its buffer.
    let mut file = File::default();
    let positions = file.floats(&SQUARE, "VEC3", 1 << 30);
    let content = file.close(one_mesh(&json!({"attributes": {"POSITION": positions}}), &node));
    assert!(problem(&content).contains("past the end"));
    // A node that is its own grandchild.
    let cycle = json!({"scenes": [{"nodes": [0]}], "nodes": [{"children": [1]}, {"children": [0]}]});
    assert!(problem(&File::default().close(cycle)).contains("reached twice"));
    // What the validator of `gltf` 1.4 panics at: positions that are not there, images of no stated type.
    let content = File::default().close(one_mesh(&json!({"attributes": {"POSITION": 0}}), &node));
    assert!(problem(&content).contains("accessor 0 is missing"));
    let mut file = File::default();
    file.view(&[0; 4]);
    let content = file.close(json!({"images": [{"bufferView": 0, "uri": "a.png"}]}));
    assert!(problem(&content).contains("image 0 has no source"));
    // An extension without which the file cannot be read.
    let mut members = one_mesh(&json!({"attributes": {"POSITION": 0}}), &node);
    members["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let mut file = File::default();
    file.floats(&SQUARE, "VEC3", 4);
    assert!(problem(&file.close(members)).contains("extensionsRequired"));
}

#[test]
fn a_document_with_files_beside_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("square.gltf");
    let document = |uri: &str| {
        json!({
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "buffers": [{"byteLength": 48, "uri": uri}],
            "bufferViews": [{"buffer": 0, "byteLength": 48}],
            "accessors": [{"bufferView": 0, "componentType": F32, "type": "VEC3", "count": 3,
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
        })
    };
    std::fs::write(folder.path().join("a b.bin"), bytemuck::cast_slice(&SQUARE)).unwrap();
    std::fs::write(&path, document("a%20b.bin").to_string()).unwrap();
    let scene = load(&path).unwrap();
    assert_eq!((scene.name.as_str(), scene.triangles.len()), ("square", 1));
    for (uri, expected) in
        [("c.bin", "cannot be read"), ("%ff.bin", "not percent-encoded"), ("http://a/b", "legal are data:")]
    {
        std::fs::write(&path, document(uri).to_string()).unwrap();
        let text = load(&path).unwrap_err().to_string();
        assert!(text.contains(expected) && text.contains("square.gltf"), "{text}");
    }
}

#[test]
fn errors_are_one_line_with_the_path() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    assert!(load(&path).unwrap_err().to_string().contains("expected a .glb or .gltf file"));
    for content in
        [&b""[..], b"glTF", b"PK\x03\x04 a foreign file", b"{\"asset\": {\"version\": \"2.0\"},\n \"nodes\": [1]}"]
    {
        std::fs::write(&path, content).unwrap();
        let text = load(&path).unwrap_err().to_string();
        assert!(text.contains("scene.glb: ") && !text.contains('\n'), "{text}");
    }
}

#[test]
fn every_truncation_is_an_error() {
    let content = square(5, Some((U8, &[0, 1, 2, 3])), &json!({"mesh": 0}));
    assert!(parse(&content, None).is_ok());
    for length in 0..content.len() {
        assert!(parse(&content[..length], None).is_err(), "the first {length} bytes");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    /// Damage at any places gives a scene or an error; what comes out is consistent.
    #[test]
    fn damage_never_panics(places in prop::collection::vec((0..4000_usize, any::<u8>()), 1..4)) {
        let texture = json!({"baseColorTexture": {"index": 0}});
        let mut content = card(&json!({"alphaMode": "MASK", "pbrMetallicRoughness": texture}), true);
        for (place, byte) in places {
            let length = content.len();
            content[place % length] = byte;
        }
        if let Ok(scene) = parse(&content, None) {
            prop_assert!(scene.positions.iter().all(|position| position.is_finite()));
            prop_assert!(scene.triangles.iter().flatten().all(|&index| (index as usize) < scene.positions.len()));
            prop_assert!(scene.cutouts.is_empty() || scene.uvs.len() == scene.positions.len());
        }
    }
}

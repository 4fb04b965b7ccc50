//! Truth on disk: tracing takes seconds, and benches ask for the same pictures again and again.
//!
//! A file is named by the hash of everything the truth depends on, and ends with the hash of its own content: what is
//! damaged, short or of another format is traced anew, never believed.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::disc::{AREA_RAYS, CENTRE_RAYS};
use super::{COARSE_GRID, FINE_GRID, SHADOW_START, SURFACE_SINE, Truth};
use crate::lab::case::Case;
use crate::lab::scene::SceneModel;

/// Grows with every change of what [`Truth::trace`] computes or how it is stored.
const VERSION: u32 = 2;

/// Names the cache folder instead of `target/antumbra-truth`.
pub const CACHE_VARIABLE: &str = "ANTUMBRA_TRUTH_CACHE";

/// Folder that holds traced truths.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TruthCache {
    /// The folder; made when the first truth is stored.
    pub folder: PathBuf,
}

/// What the cache did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CacheUse {
    /// The truth was read from disk.
    Read,
    /// The truth was traced and stored.
    Traced,
    /// The truth was traced, but could not be stored, for this reason.
    NotStored(String),
}

impl Default for TruthCache {
    /// The folder of [`CACHE_VARIABLE`], else `antumbra-truth` in `CARGO_TARGET_DIR`, else in `target`.
    fn default() -> Self {
        let named = std::env::var_os(CACHE_VARIABLE).map(PathBuf::from);
        let target = || std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
        Self { folder: named.unwrap_or_else(|| target().join("antumbra-truth")) }
    }
}

impl TruthCache {
    /// Reads the truth of a case, or traces and stores it; `on_row` is called as by [`Truth::trace`].
    #[must_use]
    pub fn get(&self, case: &Case, scene: &SceneModel, on_row: &(dyn Fn() + Sync)) -> (Truth, CacheUse) {
        self.soft(case, scene, 0.0, on_row)
    }

    /// The same of [`Truth::soft`], for a light of this angular diameter, radians, 0 to 0.5.
    #[must_use]
    pub fn soft(&self, case: &Case, scene: &SceneModel, angle: f64, on_row: &(dyn Fn() + Sync)) -> (Truth, CacheUse) {
        let path = self.soft_path(case, scene, angle);
        let [width, height] = case.viewport;
        let stored = std::fs::read(&path).ok().and_then(|content| decode(&content, width, height));
        if let Some(truth) = stored {
            return (truth, CacheUse::Read);
        }
        let truth = Truth::soft(case, scene, angle, on_row);
        let cache_use = match self.store(&path, &truth) {
            Ok(()) => CacheUse::Traced,
            Err(error) => CacheUse::NotStored(error.to_string()),
        };
        (truth, cache_use)
    }

    /// Returns the file for a case: a hash of geometry, camera, light, viewport and the rules of tracing.
    #[must_use]
    pub fn path(&self, case: &Case, scene: &SceneModel) -> PathBuf {
        self.soft_path(case, scene, 0.0)
    }

    /// The same for a light of this angular diameter; that of lights without size does not depend on what only others
    /// need.
    fn soft_path(&self, case: &Case, scene: &SceneModel, angle: f64) -> PathBuf {
        let mut hasher = blake3::Hasher::new();
        hasher.update(&VERSION.to_le_bytes());
        hasher.update(bytemuck::cast_slice(&[COARSE_GRID, FINE_GRID]));
        hasher.update(bytemuck::cast_slice(&[SHADOW_START, SURFACE_SINE]));
        // Debug text of f64 gives every bit back, so different cases differ.
        hasher.update(format!("{:?} {:?} {:?}", case.camera, case.light, case.viewport).as_bytes());
        scene.hash_content(&mut hasher);
        if angle != 0.0 {
            hasher.update(bytemuck::cast_slice(&[CENTRE_RAYS, AREA_RAYS]));
            hasher.update(&angle.to_le_bytes());
        }
        self.folder.join(format!("{}.truth", hasher.finalize().to_hex()))
    }

    /// Writes under another name and renames, so that nobody reads half a file.
    fn store(&self, path: &Path, truth: &Truth) -> std::io::Result<()> {
        std::fs::create_dir_all(&self.folder)?;
        let mut file = tempfile::NamedTempFile::new_in(&self.folder)?;
        file.write_all(&encode(truth))?;
        file.persist(path)?;
        Ok(())
    }
}

/// Bytes of one pixel in a file.
const PIXEL_BYTES: usize = 1 + 1 + 4 + 4 + 4 + 12 + 4;

/// Lays a truth out as list after list, and its hash.
fn encode(truth: &Truth) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(truth.valid.len() * PIXEL_BYTES + blake3::OUT_LEN);
    bytes.extend(truth.valid.iter().map(|&valid| u8::from(valid)));
    bytes.extend_from_slice(&truth.joins);
    bytes.extend_from_slice(bytemuck::cast_slice(&truth.centre));
    bytes.extend_from_slice(bytemuck::cast_slice(&truth.area));
    bytes.extend_from_slice(bytemuck::cast_slice(&truth.depth));
    bytes.extend_from_slice(bytemuck::cast_slice(&truth.normal));
    bytes.extend_from_slice(bytemuck::cast_slice(&truth.triangle));
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    bytes
}

/// Takes apart what [`encode`] made; `None` for anything else.
fn decode(content: &[u8], width: u32, height: u32) -> Option<Truth> {
    // Check length and hash.
    let count = width as usize * height as usize;
    let (bytes, hash) = content.split_at_checked(count * PIXEL_BYTES)?;
    if hash != blake3::hash(bytes).as_bytes() {
        return None;
    }
    // Cut list after list off.
    let mut rest = bytes;
    let mut take = |length: usize| {
        let (list, after) = rest.split_at(length);
        rest = after;
        list
    };
    Some(Truth {
        width,
        height,
        valid: take(count).iter().map(|&valid| valid != 0).collect(),
        joins: take(count).to_vec(),
        centre: bytemuck::pod_collect_to_vec(take(count * 4)),
        area: bytemuck::pod_collect_to_vec(take(count * 4)),
        depth: bytemuck::pod_collect_to_vec(take(count * 4)),
        normal: bytemuck::pod_collect_to_vec(take(count * 12)),
        triangle: bytemuck::pod_collect_to_vec(take(count * 4)),
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::lab::case::{CaseCamera, CaseLight};

    fn small() -> (Case, SceneModel) {
        let positions = vec![DVec3::new(-9.0, 0.0, 9.0), DVec3::new(9.0, 0.0, 9.0), DVec3::new(0.0, 0.0, -9.0)];
        let scene = SceneModel { positions, triangles: vec![[0, 1, 2]], ..SceneModel::default() };
        let (eye, target) = (DVec3::new(0.0, 3.0, 3.0), DVec3::ZERO);
        let case = Case {
            name: "small".into(),
            scene: "small".into(),
            camera: CaseCamera { eye, target, up: DVec3::Y, fov_y_deg: 60.0, near: 0.1, far: 50.0 },
            light: CaseLight::Directional { travel: DVec3::NEG_Y },
            viewport: [8, 6],
            shadow_distance: 50.0,
            folder: PathBuf::new(),
        };
        (case, scene)
    }

    #[test]
    fn a_stored_truth_comes_back_and_damage_is_traced_anew() {
        let folder = tempfile::tempdir().unwrap();
        let cache = TruthCache { folder: folder.path().join("made/on/demand") };
        let (case, scene) = small();
        let (traced, first) = cache.get(&case, &scene, &|| ());
        let (read, second) = cache.get(&case, &scene, &|| ());
        assert_eq!((first, second), (CacheUse::Traced, CacheUse::Read));
        assert_eq!(traced, read);
        // Flip one bit; cut the end off; empty the file.
        let path = cache.path(&case, &scene);
        let good = std::fs::read(&path).unwrap();
        let mut flipped = good.clone();
        flipped[100] ^= 1;
        for bad in [flipped, good[..good.len() - 1].to_vec(), Vec::new()] {
            std::fs::write(&path, bad).unwrap();
            let (again, cache_use) = cache.get(&case, &scene, &|| ());
            assert_eq!((again, cache_use), (traced.clone(), CacheUse::Traced));
            assert_eq!(std::fs::read(&path).unwrap(), good, "the damaged file is replaced");
        }
    }

    #[test]
    fn the_name_depends_on_what_the_truth_depends_on() {
        let cache = TruthCache { folder: PathBuf::new() };
        let (case, scene) = small();
        let path = cache.path(&case, &scene);
        let renamed = Case { name: "other".into(), shadow_distance: 7.0, ..case.clone() };
        assert_eq!(cache.path(&renamed, &scene), path);
        let mut moved = case.clone();
        moved.camera.eye.x = 1e-15;
        assert_ne!(cache.path(&moved, &scene), path);
        let mut bent = scene.clone();
        bent.positions[0].x += 1e-12;
        assert_ne!(cache.path(&case, &bent), path);
        let [none, narrow, wide] = [0.0, 0.01, 0.02].map(|angle| cache.soft_path(&case, &scene, angle));
        assert!(none == path && narrow != path && wide != path && wide != narrow);
        // Lights without size keep their files, whatever was learnt about others.
        let name = path.file_name().unwrap().to_str().unwrap();
        assert_eq!(name, "240755bbc33b5d70def18d7eeb095427a19d8d4063cd797657e0d0285dddb0b5.truth");
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_reported_and_the_truth_still_comes() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let cache = TruthCache { folder: file.path().join("below-a-file") };
        let (case, scene) = small();
        let (truth, cache_use) = cache.get(&case, &scene, &|| ());
        assert!(matches!(cache_use, CacheUse::NotStored(_)));
        assert!(truth.valid_count() > 0);
    }
}

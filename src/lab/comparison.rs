//! The main job: techniques × map sizes over scenes and cases, against the truth.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use image::ExtendedColorType;

use super::case::{BUILT_IN_SCENES, Case, SceneSource};
use super::cli::encode_png;
use super::cpu::Visible;
use super::experiment::{Backend, RunError, Shot, Studio, stage_names};
use super::files::with_extension;
use super::footprint::{COARSENESS, Measured};
use super::metrics::{Scores, heat_map, mask_from_bytes};
use super::report::{Picture, Row, SceneSection};
use super::sparse_city::sparse_city;
use super::subject::{Setting, Subject, case_of};
use super::tour;
use super::treeline::treeline;
use super::truth::Truth;
use super::viewpoints::{sparse_city_viewpoints, treeline_viewpoints};
use crate::remix::Remix;

/// The environment variable that names the folder of shared scenes.
pub(super) const SCENES: &str = "ANTUMBRA_SCENES";

/// The folder of shared scenes, beside which their case files lie in `../cases`: what `ANTUMBRA_SCENES` names.
#[must_use]
pub fn shared_scenes() -> Option<PathBuf> {
    std::env::var_os(SCENES).map(PathBuf::from)
}

/// The case files beside the folder of shared scenes, by name; none where `ANTUMBRA_SCENES` names no folder.
///
/// # Errors
/// One line, where that folder cannot be read or holds no case.
pub fn shared_case_files() -> Result<Vec<PathBuf>, String> {
    shared_scenes().map_or_else(|| Ok(Vec::new()), |scenes| cases_in(&scenes.join("../cases")))
}

/// The case files of a folder, of which there must be one.
fn cases_in(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let files = with_extension(folder, "json")?;
    if files.is_empty() {
        return Err(format!("{} holds no case; legal: at least one .json file", folder.display()));
    }
    Ok(files)
}

/// A scene and the cases that are photographed in it.
#[derive(Debug)]
pub struct Assignment {
    /// Name of the scene in reports.
    pub scene: String,
    /// The scene.
    pub subject: Subject,
    /// What is photographed.
    pub cases: Vec<Case>,
}

impl Assignment {
    /// A built-in scene with its own viewpoints, or a file with viewpoints around it.
    ///
    /// # Errors
    /// One line that names the scene and what is legal.
    pub fn of_scene(name: &str) -> Result<Self, String> {
        let (subject, viewpoints) = match name {
            "treeline" => (Subject::new(treeline()), treeline_viewpoints()),
            "sparse-city" => (Subject::new(sparse_city()), sparse_city_viewpoints()),
            file => {
                let path = Path::new(file);
                if !path.exists() {
                    let built_in = BUILT_IN_SCENES.join(", ");
                    return Err(format!("scene is \"{file}\"; legal: {built_in}, or a .glb or .gltf file that exists"));
                }
                let subject = Subject::load_file(path).map_err(|error| error.to_string())?;
                let viewpoints = tour::around(&subject.model.name, &subject.bounds);
                (subject, viewpoints)
            }
        };
        let scene = subject.model.name.clone();
        let cases = viewpoints.iter().map(|viewpoint| case_of(viewpoint, &scene)).collect();
        Ok(Self { scene, subject, cases })
    }

    /// The scene of a case file, with that case alone.
    ///
    /// # Errors
    /// One line that names the field and what is legal.
    pub fn of_case(path: &Path) -> Result<Self, String> {
        let case = Case::load(path).map_err(|error| error.to_string())?;
        let source: SceneSource = case.scene_source().map_err(|error| error.to_string())?;
        let subject = Subject::load(&source).map_err(|error| error.to_string())?;
        Ok(Self { scene: subject.model.name.clone(), subject, cases: vec![case] })
    }

    /// Every shared case, by file name; none where `ANTUMBRA_SCENES` names no folder.
    ///
    /// # Errors
    /// One line: the folder cannot be read or holds no case, or as of [`of_case`](Self::of_case).
    pub fn shared() -> Result<Vec<Self>, String> {
        shared_case_files()?.iter().map(|path| Self::of_case(path)).collect()
    }
}

/// What every case is photographed with.
#[derive(Clone, Debug)]
pub struct Programme {
    /// Techniques by name.
    pub techniques: Vec<(String, Remix)>,
    /// Sides of maps, texels.
    pub sizes: Vec<u32>,
    /// How often each pass is drawn for its median time.
    pub repetitions: u32,
}

/// Most pictures of a case: a page of all techniques at all sizes would weigh some 60 MB. Fewer show less;
/// more load slowly.
const MOST_PICTURES: usize = 10;

impl Programme {
    /// Whether maps of this size are shown as pictures: all sizes where these are few, else the middle one.
    /// Tables and plots have them all.
    fn pictures(&self, size: u32) -> bool {
        let few = self.techniques.len() * self.sizes.len() <= MOST_PICTURES;
        few || self.sizes.get(self.sizes.len() / 2) == Some(&size)
    }
}

/// Photographs one case with every technique and size; `on_run` is called after each run.
///
/// A run that fails is a row too, with its error; nothing is dropped.
///
/// # Errors
/// The backend cannot hold the scene, or a picture cannot be encoded.
pub fn photograph(
    backend: &mut Backend,
    assignment: &Assignment,
    case: &Case,
    truth: &Truth,
    programme: &Programme,
    on_run: &mut dyn FnMut(&Row),
) -> Result<SceneSection, String> {
    let (backend_name, adapter) = (backend.name().to_owned(), backend.adapter());
    let setting = Setting::of(case);
    let visible = Visible::draw(&assignment.subject.model, &setting.camera, setting.origin);
    let mut studio = Studio::new(backend, &assignment.subject, setting).map_err(|error| error.to_string())?;
    let mut section = SceneSection {
        scene: assignment.scene.clone(),
        case: case.name.clone(),
        description: describe(assignment, case, truth),
        truth_png: png_of(&truth.area, case)?,
        ..SceneSection::default()
    };
    for (name, remix) in &programme.techniques {
        for &size in &programme.sizes {
            let [split, warp, encoding] = stage_names(remix);
            let mut row = Row {
                scene: assignment.scene.clone(),
                case: case.name.clone(),
                technique: name.clone(),
                split,
                warp,
                encoding,
                size,
                backend: backend_name.clone(),
                adapter: adapter.clone(),
                ..Row::default()
            };
            match run(&mut studio, remix, size, programme.repetitions, truth) {
                Ok((shot, scores)) => {
                    shot.fill(&mut row, &scores);
                    if programme.pictures(size) {
                        let measured = Measured::new(&visible, &shot.frame, &setting, &truth.valid);
                        section.pictures.push(picture(&shot, &scores, truth, case, &measured, &row)?);
                    }
                }
                Err(error) => row.left_out = vec![error.to_string()],
            }
            on_run(&row);
            section.rows.push(row);
        }
    }
    Ok(section)
}

fn run(
    studio: &mut Studio,
    remix: &Remix,
    size: u32,
    repetitions: u32,
    truth: &Truth,
) -> Result<(Shot, Scores), RunError> {
    let shot = studio.shoot(remix, size, repetitions)?;
    let scores = shot.scores(truth)?;
    Ok((shot, scores))
}

fn picture(
    shot: &Shot,
    scores: &Scores,
    truth: &Truth,
    case: &Case,
    measured: &Measured,
    row: &Row,
) -> Result<Picture, String> {
    let [width, height] = case.viewport;
    let coarse = [width, height].map(|side| side.div_ceil(COARSENESS as u32));
    let heat = heat_map(&mask_from_bytes(&shot.mask), truth).map_err(|error| error.to_string())?;
    let mut caption = format!(
        "away from edges: leak {:.3} %, acne {:.3} %",
        100.0 * scores.leak_interior,
        100.0 * scores.false_interior
    );
    if shot.frame.views.is_empty() {
        let _ = write!(caption, "; no map");
    }
    Ok(Picture {
        technique: row.technique.clone(),
        size: row.size,
        png: encode_png(&shot.mask, width, height, ExtendedColorType::L8)?,
        heat_png: encode_png(&heat, width, height, ExtendedColorType::Rgb8)?,
        footprint_png: if shot.frame.views.is_empty() {
            Vec::new()
        } else {
            encode_png(&measured.paint(width as usize), coarse[0], coarse[1], ExtendedColorType::Rgb8)?
        },
        footprint: footprint_line(shot, measured),
        caption,
    })
}

/// Texels in the picture as they were measured, and beside them what the fit predicted.
fn footprint_line(shot: &Shot, measured: &Measured) -> String {
    let (Some(texel), Some(facing)) = (measured.pixels_per_texel, measured.perspective) else {
        return String::new();
    };
    let predicted = shot.frame.predicted;
    let mut line = format!(
        "texel {} px ({}–{})\nwithout slant {} px ({}–{})\npredicted {}–{}",
        digits(texel.median),
        digits(texel.low),
        digits(texel.high),
        digits(facing.median),
        digits(facing.min),
        digits(facing.max),
        digits(predicted.min.into()),
        digits(predicted.max.into()),
    );
    if measured.unserved > LEAST_UNSERVED {
        let _ = write!(line, "\n{:.1} % outside the map", 100.0 * measured.unserved);
    }
    line
}

/// Share of the valid pixels outside of a map from which on it is said: less is rounding at the map's edge.
const LEAST_UNSERVED: f64 = 5e-4;

/// A length in pixels with two digits or so.
fn digits(pixels: f64) -> String {
    match pixels {
        pixels if !pixels.is_finite() => "∞".to_owned(),
        pixels if pixels >= 1e4 => format!("{pixels:.0e}"),
        pixels if pixels >= 10.0 => format!("{pixels:.0}"),
        pixels if pixels >= 1.0 => format!("{pixels:.1}"),
        pixels => format!("{pixels:.2}"),
    }
}

/// One sentence about a case.
fn describe(assignment: &Assignment, case: &Case, truth: &Truth) -> String {
    let camera = &case.camera;
    let [width, height] = case.viewport;
    let shadowed = truth.centre.iter().zip(&truth.valid).filter(|(lit, valid)| **valid && **lit < 1.0).count();
    format!(
        "{} triangles in {} objects; {width} × {height} pixels, vertical field of view {:.0}°, depths {} to {}; \
         {:.0} % of the {} valid pixels in shadow.",
        assignment.subject.model.triangles.len(),
        assignment.subject.objects.len(),
        camera.fov_y_deg,
        camera.near,
        camera.far,
        100.0 * shadowed as f64 / truth.valid_count().max(1) as f64,
        truth.valid_count(),
    )
}

/// A picture of the area truth; sky is white, as in masks.
fn png_of(area: &[f32], case: &Case) -> Result<Vec<u8>, String> {
    let [width, height] = case.viewport;
    let byte = |lit: &f32| (lit * f32::from(u8::MAX)).round() as u8;
    let bytes: Vec<u8> = area.iter().map(byte).collect();
    encode_png(&bytes, width, height, ExtendedColorType::L8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_without_cases_is_a_mistake() {
        let folder = tempfile::tempdir().unwrap();
        assert!(cases_in(folder.path()).unwrap_err().contains("holds no case"));
        assert!(cases_in(&folder.path().join("none")).unwrap_err().contains("none"));
        for name in ["b.json", "a.json", "read.me"] {
            std::fs::write(folder.path().join(name), "{}").unwrap();
        }
        assert_eq!(cases_in(folder.path()).unwrap(), ["a.json", "b.json"].map(|name| folder.path().join(name)));
    }
}

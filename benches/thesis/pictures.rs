//! The thesis's figures, drawn again.

use std::path::Path;

use antumbra::lab::case::{Case, CaseLight};
use antumbra::lab::files::write_whole;
use antumbra::lab::subject::Subject;
use antumbra::lab::truth::Truth;
use glam::DVec3;

use crate::maps::MapSight;
use crate::measure::{Record, Results, called};
use crate::montage::{Picture, montage};
use crate::programme::{PLUS, PSSM, Programme, SHOWN, SIX, SMRA, SSM, TSM, UNFILTERED, VSM};

/// Width and height of the part of a picture that shows errors, pixels.
const CROP: [usize; 2] = [400, 300];

/// By how much that part is moved while the one with the most to see is sought, pixels.
const STRIDE: usize = 50;

/// What the colours of errors mean.
pub(crate) const ERROR_COLOURS: &str = "orange-red where light leaks, blue where shadow is false, else light grey where the truth is lit, dark grey where it is in shadow, black where \
     nothing is judged (sky, and what is turned away from the light)";

/// Where the pictures lie beside the page.
pub(crate) const FOLDER: &str = "thesis";

/// A picture that is looked at closely: its errors under several techniques, where the first two differ most.
pub(crate) struct Shown {
    pub(crate) scene: String,
    pub(crate) case: String,
    pub(crate) size: u32,
    pub(crate) names: Vec<&'static str>,
    /// Its file.
    pub(crate) file: &'static str,
}

impl Shown {
    /// What a record shows, and the same under other techniques.
    pub(crate) fn of(record: &Record, names: &[&'static str], file: &'static str) -> Self {
        let (scene, case) = (record.scene.clone(), record.case.clone());
        Self { scene, case, size: record.size, names: names.to_vec(), file }
    }
}

/// Writes them all.
pub(crate) fn write(programme: &Programme, results: &mut Results, shown: &[&Shown], docs: &Path) -> Result<(), String> {
    let folder = docs.join(FOLDER);
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let save = |name: &str, picture: &Picture| write_whole(&folder.join(name), &picture.encode()?);
    let mut viewpoints = Vec::new();
    for assignment in &programme.built_in()? {
        for case in &assignment.cases {
            let truth = results.truth(assignment, case);
            let lit = Picture::shaded(&truth, Some(&bytes(&truth)), travel(case));
            viewpoints.push((case.name.clone(), lit.halved().halved()));
            if SHOWN.contains(&(assignment.scene.as_str(), case.name.as_str())) {
                let name = &assignment.scene;
                let scene = Sight { results, truth: &truth, case: called(assignment, case), travel: travel(case) };
                save(&format!("{name}-techniques.jpg"), &scene.techniques(programme.sizes()[0])?)?;
                save(&format!("{name}-maps.jpg"), &scene.maps(&assignment.subject, case, programme.sizes()[0])?)?;
                save(&format!("{name}-sizes.jpg"), &scene.sizes(programme.sizes())?)?;
            }
            for shown in shown.iter().filter(|shown| *shown.scene == assignment.scene && shown.case == case.name) {
                let sight = Sight { results, truth: &truth, case: called(assignment, case), travel: travel(case) };
                save(shown.file, &sight.closely(shown)?)?;
            }
        }
    }
    save("viewpoints.jpg", &montage(&viewpoints, viewpoints.len().div_ceil(2)))
}

/// The area truth as a mask.
fn bytes(truth: &Truth) -> Vec<u8> {
    truth.area.iter().map(|area| (area * f32::from(u8::MAX)).round() as u8).collect()
}

/// Where light travels; nowhere for lights of another kind.
fn travel(case: &Case) -> DVec3 {
    if let CaseLight::Directional { travel } = case.light { travel } else { DVec3::ZERO }
}

/// A case, and what was seen of it.
struct Sight<'a> {
    results: &'a Results,
    truth: &'a Truth,
    case: String,
    travel: DVec3,
}

impl Sight<'_> {
    fn shaded(&self, name: &'static str, size: u32) -> Result<Picture, String> {
        let mask = self.mask(name, size)?;
        Ok(Picture::shaded(self.truth, Some(mask), self.travel))
    }

    fn mask(&self, name: &'static str, size: u32) -> Result<&[u8], String> {
        let key = (self.case.clone(), size, name);
        self.results.masks.get(&key).map(Vec::as_slice).ok_or_else(|| format!("{}: no picture of {name}", self.case))
    }

    /// Figures 49, 50 and 52.
    fn maps(&self, subject: &Subject, case: &Case, size: u32) -> Result<Picture, String> {
        let sight = MapSight::new(subject, case);
        let mut served = vec![("truth".to_owned(), Picture::shaded(self.truth, Some(&bytes(self.truth)), self.travel))];
        for name in [PSSM, PLUS] {
            served.push((format!("{name} maps"), sight.served(name, size, &self.shaded(name, size)?)?));
        }
        let served: Vec<_> = served.into_iter().map(|(name, picture)| (name, picture.halved())).collect();
        Ok(montage(&sight.maps()?, 4).above(&montage(&served, 3)))
    }

    /// Figures 47, 48, 51 and 53 to 56.
    fn techniques(&self, size: u32) -> Result<Picture, String> {
        let bare = Picture::shaded(self.truth, None, self.travel).halved();
        let mut pictures = vec![("no shadows".to_owned(), bare)];
        for name in [SSM, TSM, PSSM, UNFILTERED, VSM, SMRA, PLUS] {
            pictures.push((name.to_owned(), self.shaded(name, size)?.halved()));
        }
        let truth = Picture::shaded(self.truth, Some(&bytes(self.truth)), self.travel);
        pictures.push(("truth".to_owned(), truth.halved()));
        Ok(montage(&pictures, 3))
    }

    /// Figures 58 to 62 and 64 to 68.
    fn sizes(&self, sizes: &[u32]) -> Result<Picture, String> {
        let mut pictures = Vec::new();
        for name in SIX {
            for &size in sizes {
                pictures.push((format!("{name} {size}"), self.shaded(name, size)?.halved()));
            }
        }
        Ok(montage(&pictures, sizes.len()))
    }

    /// Shadows above, their errors below, where the first two techniques differ most.
    fn closely(&self, shown: &Shown) -> Result<Picture, String> {
        let corner = match shown.names[..] {
            [a, b, ..] => self.most_different(self.mask(a, shown.size)?, self.mask(b, shown.size)?),
            _ => [0; 2],
        };
        let mut pictures = Vec::new();
        for &name in &shown.names {
            pictures.push((name.to_owned(), self.shaded(name, shown.size)?.cropped(corner, CROP)));
        }
        for &name in &shown.names {
            let errors = Picture::errors(self.truth, self.mask(name, shown.size)?)?;
            pictures.push((format!("{name} error"), errors.cropped(corner, CROP)));
        }
        Ok(montage(&pictures, shown.names.len()))
    }

    /// Corner of the part in which two masks differ most.
    fn most_different(&self, a: &[u8], b: &[u8]) -> [usize; 2] {
        let (width, height) = (self.truth.width as usize, self.truth.height as usize);
        let difference = |[left, top]: [usize; 2]| -> u64 {
            let rows = top..top + CROP[1];
            let pixels = rows.flat_map(|row| row * width + left..row * width + left + CROP[0]);
            pixels.filter(|pixel| self.truth.valid[*pixel]).map(|pixel| u64::from(a[pixel].abs_diff(b[pixel]))).sum()
        };
        let columns = (0..=width - CROP[0]).step_by(STRIDE);
        let corners = columns.flat_map(|left| (0..=height - CROP[1]).step_by(STRIDE).map(move |top| [left, top]));
        corners.max_by_key(|corner| difference(*corner)).unwrap_or_default()
    }
}

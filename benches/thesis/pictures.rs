//! The thesis's figures, drawn again.

use std::path::Path;

use antumbra::lab::case::{Case, CaseLight};
use antumbra::lab::comparison::Assignment;
use antumbra::lab::files::write_whole;
use antumbra::lab::truth::Truth;
use glam::DVec3;

use crate::measure::{Results, called};
use crate::montage::{Picture, montage};
use crate::programme::{PLUS, PSSM, Programme, SHOWN, SIX, SMRA, SSM, TSM, UNFILTERED, VSM};

/// Width and height of the part of a picture that shows errors, pixels.
const CROP: [usize; 2] = [400, 300];

/// By how much that part is moved while the one with the most to see is sought, pixels.
const STRIDE: usize = 50;

/// Where the pictures lie beside the page.
pub(crate) const FOLDER: &str = "thesis";

/// The picture in which SMRA's maps, not filtered, lose most against parallel splits, or gain least.
pub(crate) struct Shown {
    pub(crate) scene: String,
    pub(crate) case: String,
    pub(crate) size: u32,
}

/// Writes them all.
pub(crate) fn write(programme: &Programme, results: &mut Results, shown: &Shown, docs: &Path) -> Result<(), String> {
    let folder = docs.join(FOLDER);
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let save = |name: &str, picture: &Picture| write_whole(&folder.join(name), &picture.encode()?);
    for assignment in &programme.built_in()? {
        for case in &assignment.cases {
            let truth = results.truth(assignment, case);
            if SHOWN.contains(&(assignment.scene.as_str(), case.name.as_str())) {
                let name = &assignment.scene;
                let scene = Sight { results, truth: &truth, case: called(assignment, case), travel: travel(case) };
                save(&format!("{name}-techniques.jpg"), &scene.techniques(programme.sizes()[0])?)?;
                save(&format!("{name}-sizes.jpg"), &scene.sizes(programme.sizes())?)?;
            }
            if *shown.scene == assignment.scene && shown.case == case.name {
                save("why.jpg", &why(results, assignment, case, &truth, shown.size)?)?;
            }
        }
    }
    Ok(())
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

    /// Figures 47 to 56.
    fn techniques(&self, size: u32) -> Result<Picture, String> {
        let bare = Picture::shaded(self.truth, None, self.travel).halved();
        let mut pictures = vec![("no shadows".to_owned(), bare)];
        for name in [SSM, TSM, PSSM, UNFILTERED, VSM, SMRA, PLUS] {
            pictures.push((name.to_owned(), self.shaded(name, size)?.halved()));
        }
        let truth: Vec<u8> = self.truth.area.iter().map(|area| (area * 255.0).round() as u8).collect();
        pictures.push(("truth".to_owned(), Picture::shaded(self.truth, Some(&truth), self.travel).halved()));
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
}

/// Errors of parallel splits, of the same with trapezoids, and of those filtered, where the first two differ most.
fn why(results: &Results, assignment: &Assignment, case: &Case, truth: &Truth, size: u32) -> Result<Picture, String> {
    let sight = Sight { results, truth, case: called(assignment, case), travel: travel(case) };
    let (plain, warped) = (sight.mask(PSSM, size)?, sight.mask(UNFILTERED, size)?);
    let (width, height) = (truth.width as usize, truth.height as usize);
    let difference = |[left, top]: [usize; 2]| -> u64 {
        let rows = top..top + CROP[1];
        let pixels = rows.flat_map(|row| row * width + left..row * width + left + CROP[0]);
        pixels.filter(|pixel| truth.valid[*pixel]).map(|pixel| u64::from(plain[pixel].abs_diff(warped[pixel]))).sum()
    };
    let columns = (0..=width - CROP[0]).step_by(STRIDE);
    let corners = columns.flat_map(|left| (0..=height - CROP[1]).step_by(STRIDE).map(move |top| [left, top]));
    let corner = corners.max_by_key(|corner| difference(*corner)).unwrap_or_default();
    let mut pictures = Vec::new();
    for name in [PSSM, UNFILTERED, SMRA] {
        pictures.push((name.to_owned(), sight.shaded(name, size)?.cropped(corner, CROP)));
    }
    for name in [PSSM, UNFILTERED, SMRA] {
        let errors = Picture::errors(truth, sight.mask(name, size)?)?;
        pictures.push((format!("{name} error"), errors.cropped(corner, CROP)));
    }
    Ok(montage(&pictures, 3))
}

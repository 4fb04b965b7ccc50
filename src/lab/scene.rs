//! What the laboratory renders: triangles in world space, cut-outs, and the objects they belong to.

use std::ops::Range;

use glam::{DVec2, DVec3};

/// A triangle scene in world space (right-handed, y up, lengths in the file's units).
#[derive(Clone, Debug, Default)]
pub struct SceneModel {
    /// Name shown in reports (`treeline`, or the file's stem).
    pub name: String,
    /// Vertex positions in world space.
    pub positions: Vec<DVec3>,
    /// Texture coordinates, one per position; empty when no triangle is cut out.
    pub uvs: Vec<DVec2>,
    /// Three indices into `positions` per triangle, counter-clockwise seen from its front.
    pub triangles: Vec<[u32; 3]>,
    /// Cut-out of each triangle: an index into `cutouts`, or [`SOLID`]; empty when every triangle is solid.
    pub triangle_cutout: Vec<u32>,
    /// Alpha masks (glTF `alphaMode: MASK`).
    pub cutouts: Vec<Cutout>,
    /// The engine's view of the scene: ranges of triangles (one per mesh instance), in order, covering all of them.
    pub objects: Vec<Range<usize>>,
}

/// Marks a triangle without cut-out in [`SceneModel::triangle_cutout`].
pub const SOLID: u32 = u32::MAX;

/// An alpha mask: texels with alpha below the cutoff are holes.
#[derive(Clone, Debug)]
pub struct Cutout {
    /// Width of the mask, texels.
    pub width: u32,
    /// Height of the mask, texels.
    pub height: u32,
    /// Alpha, row 0 first (v = 0 is the top row, as in glTF), `width * height` bytes.
    pub alpha: Vec<u8>,
    /// A point is solid when its bilinearly filtered alpha (0..1) is at least this.
    pub cutoff: f32,
}

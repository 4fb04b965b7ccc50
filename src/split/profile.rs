//! How wide slices of a body are, as the light sees them: what decides the size of their texels.
//!
//! # References
//! - Lloyd, Tuft, Yoon & Manocha, *Warping and partitioning for low error shadow maps*, 2006: texels by what a map has
//!   to cover.

use arrayvec::ArrayVec;
use glam::{DVec2, DVec3, Vec3Swizzles};

use crate::camera::Camera;
use crate::focus::FocusBody;
use crate::light_space::LightSpace;
use crate::math::convex::MAX_EDGES;

/// The edges of a body, each as eye depth, place along the view and place across it, of both ends, the nearer one
/// first; and what no section goes beyond.
pub(crate) struct Profile {
    edges: ArrayVec<[DVec3; 2], MAX_EDGES>,
    /// The vertices of least and greatest place along the view, and across it.
    ends: [[DVec3; 2]; 2],
}

/// What a plane of one eye depth cuts out of a body: least and greatest place, along the view and across it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Section {
    depth: f64,
    low: DVec2,
    high: DVec2,
}

impl Section {
    /// Eye depth.
    pub(crate) fn depth(&self) -> f64 {
        self.depth
    }
}

impl Profile {
    /// Of a body in view. O(edges).
    pub(crate) fn of(body: &FocusBody, camera: &Camera, travel: DVec3, origin: DVec3) -> Self {
        // One side of every window along the view.
        let light = LightSpace::fixed(travel);
        let view = light.ray(camera.forward()).truncate();
        let light = light.turned(view.try_normalize().unwrap_or(DVec2::X));
        let place = |vertex: DVec3| light.ray(vertex).truncate().extend(camera.eye_depth(vertex, origin)).zxy();
        let ordered = |[a, b]: [DVec3; 2]| if a.x <= b.x { [a, b] } else { [b, a] };
        let mut ends = [[DVec3::INFINITY, DVec3::NEG_INFINITY]; 2];
        for vertex in body.vertices.iter().map(|vertex| place(*vertex)) {
            for (axis, [low, high]) in ends.iter_mut().enumerate() {
                *low = if vertex[axis + 1] < low[axis + 1] { vertex } else { *low };
                *high = if vertex[axis + 1] > high[axis + 1] { vertex } else { *high };
            }
        }
        Self { edges: body.edges().map(|ends| ordered(ends.map(place))).collect(), ends }
    }

    /// The section at an eye depth. O(edges).
    pub(crate) fn section(&self, depth: f64) -> Section {
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &[first, last] in &self.edges {
            if first.x <= depth && depth <= last.x {
                let length = last.x - first.x;
                let share = if length > 0.0 { (depth - first.x) / length } else { 0.0 };
                // Edges across the view lie in the section from end to end.
                let at = first.yz() + (last.yz() - first.yz()) * share;
                let other = if length > 0.0 { at } else { last.yz() };
                (low, high) = (low.min(at.min(other)), high.max(at.max(other)));
            }
        }
        Section { depth, low, high }
    }

    /// Width and height across the light, together, of the slice between two sections; 0 where there is nothing. A
    /// body is convex: between two sections it is wider than both only where it is widest of all. O(1).
    pub(crate) fn between(&self, near: &Section, far: &Section) -> f64 {
        let (mut low, mut high) = (near.low.min(far.low), near.high.max(far.high));
        let within = |vertex: &DVec3| near.depth <= vertex.x && vertex.x <= far.depth;
        for (axis, [least, greatest]) in self.ends.iter().enumerate() {
            low[axis] = if within(least) { least[axis + 1] } else { low[axis] };
            high[axis] = if within(greatest) { greatest[axis + 1] } else { high[axis] };
        }
        (high - low).max(DVec2::ZERO).element_sum()
    }

    /// The same for a slice between two eye depths. O(edges).
    pub(crate) fn size(&self, near: f64, far: f64) -> f64 {
        self.between(&self.section(near), &self.section(far))
    }
}

//! The smallest rectangle around points of the plane.
//!
//! # References
//! - Freeman & Shapira, *Determining the minimum-area encasing rectangle for an arbitrary closed curve*, 1975: one side of
//!   the smallest rectangle lies on an edge of the convex hull.
//! - Andrew, *Another efficient algorithm for convex hulls in two dimensions*, 1979: the monotone chain.

use arrayvec::ArrayVec;
use glam::DVec2;

/// Axis (unit) of the rectangle of least area around `points`; `None` when they have no area (fewer than three corners).
///
/// Exact up to rounding. Time O(n log n + h²) for h hull vertices; no allocation. `CAP` must hold all points.
pub(crate) fn least_area_axis<const CAP: usize>(points: impl Iterator<Item = DVec2>) -> Option<DVec2> {
    let hull = hull::<CAP>(points);
    if hull.len() < 3 {
        return None;
    }
    let mut best = None;
    let mut best_area = f64::INFINITY;
    for (index, &from) in hull.iter().enumerate() {
        let to = hull[(index + 1) % hull.len()];
        // Not normalised: both extents come out longer by the edge's length.
        let edge = to - from;
        let area = extent(&hull, edge).element_product() / edge.length_squared();
        if area < best_area {
            best_area = area;
            best = Some(edge);
        }
    }
    // Edges may be so short that their squares underflow.
    let edge = best?;
    (edge / edge.abs().max_element()).try_normalize()
}

/// Extent of `points` along `axis` and across it.
fn extent(points: &[DVec2], axis: DVec2) -> DVec2 {
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    for point in points {
        let at = DVec2::new(point.dot(axis), axis.perp_dot(*point));
        low = low.min(at);
        high = high.max(at);
    }
    high - low
}

/// Convex hull, counter-clockwise, without repeated or collinear vertices.
fn hull<const CAP: usize>(points: impl Iterator<Item = DVec2>) -> ArrayVec<DVec2, CAP> {
    let mut sorted: ArrayVec<DVec2, CAP> = points.filter(|point| point.is_finite()).take(CAP).collect();
    sorted.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut chain: ArrayVec<DVec2, CAP> = ArrayVec::new();
    half_chain(&mut chain, sorted.iter().copied());
    let lower = chain.len();
    let mut upper: ArrayVec<DVec2, CAP> = ArrayVec::new();
    half_chain(&mut upper, sorted.iter().rev().copied());
    // The chains share their end points.
    if lower > 0 {
        chain.truncate(lower - 1);
    }
    let tail = upper.len().saturating_sub(1);
    for point in &upper[..tail] {
        let _ = chain.try_push(*point); // at most every point once: never full
    }
    chain
}

/// Monotone chain: keeps left turns only.
fn half_chain<const CAP: usize>(chain: &mut ArrayVec<DVec2, CAP>, points: impl Iterator<Item = DVec2>) {
    for point in points {
        while let [.., a, b] = chain[..] {
            if (b - a).perp_dot(point - b) > 0.0 {
                break;
            }
            chain.pop();
        }
        let _ = chain.try_push(point);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_turned_rectangle_is_found() {
        let axis = DVec2::from_angle(0.3);
        let corners = [(-2.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-2.0, 1.0), (0.5, 0.2)];
        let points = corners.map(|(x, y)| axis * x + axis.perp() * y);
        let found = least_area_axis::<8>(points.into_iter()).unwrap();
        assert!(found.perp_dot(axis).abs() < 1e-12 || found.dot(axis).abs() < 1e-12);
    }

    #[test]
    fn degenerate_points_have_no_rectangle() {
        assert_eq!(least_area_axis::<8>([].into_iter()), None);
        assert_eq!(least_area_axis::<8>([DVec2::ONE; 5].into_iter()), None);
        let line = (0..5).map(|i| DVec2::new(f64::from(i), 2.0 * f64::from(i)));
        assert_eq!(least_area_axis::<8>(line), None);
    }

    proptest! {
        /// No other direction gives a smaller rectangle (checked over a fine fan of directions).
        #[test]
        fn least_among_many_directions(points in prop::collection::vec(prop::array::uniform2(-1.0..1.0_f64), 3..20)) {
            let points: Vec<DVec2> = points.into_iter().map(DVec2::from_array).collect();
            if let Some(axis) = least_area_axis::<20>(points.iter().copied()) {
                let ours = extent(&points, axis).element_product();
                for step in 0..360 {
                    let other = extent(&points, DVec2::from_angle(f64::from(step).to_radians())).element_product();
                    prop_assert!(ours <= other * (1.0 + 1e-9));
                }
            }
        }
    }
}

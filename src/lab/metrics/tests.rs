//! Masks made by hand over truths made by hand.

use super::*;

/// A truth on one surface, all valid, depth growing with the row; light (1) or shadow (0) per pixel, area as centre.
pub(super) fn truth(width: u32, rows: &[&str]) -> Truth {
    let centre: Vec<f32> = rows.concat().bytes().map(|byte| f32::from(u8::from(byte == b'1'))).collect();
    let (count, height) = (centre.len(), rows.len() as u32);
    assert_eq!(count, (width * height) as usize);
    let joins = |index: usize| {
        let (x, y) = (index as u32 % width, index as u32 / width);
        u8::from(x + 1 < width) * JOINS_RIGHT + u8::from(y + 1 < height) * JOINS_BELOW
    };
    Truth {
        width,
        height,
        valid: vec![true; count],
        area: centre.clone(),
        centre,
        depth: (0..count).map(|index| 1.0 + (index as u32 / width) as f32).collect(),
        normal: vec![[0.0, 1.0, 0.0]; count],
        triangle: vec![0; count],
        joins: (0..count).map(joins).collect(),
    }
}

fn scores(mask: &[f32], truth: &Truth) -> Scores {
    Scores::new(mask, truth).unwrap()
}

/// Left half in shadow, right half lit, 16 wide.
fn halves() -> Truth {
    truth(16, &["0000000011111111"; 12])
}

/// The halves with the edge moved to a column.
fn moved(column: usize) -> Vec<f32> {
    (0..16 * 12).map(|index| f32::from(u8::from(index % 16 >= column))).collect()
}

#[test]
fn a_perfect_mask_scores_the_floor() {
    let mut truth = halves();
    // The edge passes through column 8: three quarters of it are lit.
    (0..12).for_each(|row| truth.area[row * 16 + 8] = 0.75);
    let scores = scores(&truth.centre, &truth);
    assert_eq!(scores.mae, 0.25 / 16.0);
    assert_eq!(scores.rmse, (0.0625_f64 / 16.0).sqrt());
    assert_eq!((scores.floor_mae, scores.floor_rmse, scores.excess), (scores.mae, scores.rmse, 0.0));
    assert_eq!((scores.wrong, scores.wrong_center, scores.edge_center_px), (0.0, 0.0, Some(0.0)));
    let all_four = [scores.leak_edge, scores.leak_interior, scores.false_edge, scores.false_interior];
    assert_eq!(all_four, [0.0; 4]);
}

#[test]
fn a_perfect_filter_has_negative_excess() {
    let mut truth = halves();
    (0..12).for_each(|row| truth.area[row * 16 + 8] = 0.75);
    let scores = scores(&truth.area, &truth);
    assert_eq!((scores.mae, scores.rmse, scores.excess), (0.0, 0.0, -0.25 / 16.0));
}

#[test]
fn a_moved_edge_is_displaced_and_wrong_by_its_sign() {
    let truth = halves();
    for (column, leak, false_shadow, distance) in [(7, 1, 0, 1.0), (6, 2, 0, 2.0), (10, 0, 2, 2.0)] {
        let scores = scores(&moved(column), &truth);
        assert_eq!(scores.leak_edge, f64::from(leak) / 16.0);
        assert_eq!(scores.false_edge, f64::from(false_shadow) / 16.0);
        assert_eq!(scores.wrong_center, f64::from(leak + false_shadow) / 16.0);
        assert_eq!(scores.wrong, scores.wrong_center);
        assert_eq!(scores.edge_center_px, Some(distance));
        assert_eq!(scores.leak_interior + scores.false_interior, 0.0);
    }
}

#[test]
fn wrong_pixels_further_than_the_reach_are_interior() {
    let truth = halves();
    // Columns 7 and 8 are edge pixels; 5..=10 are near. A leak at 4 and a false shadow at 11 are not.
    let mut mask = truth.centre.clone();
    (mask[5 * 16 + 4], mask[6 * 16 + 5], mask[5 * 16 + 11], mask[6 * 16 + 10]) = (1.0, 1.0, 0.0, 0.0);
    let scores = scores(&mask, &truth);
    let one = 1.0 / (16.0 * 12.0);
    let found = [scores.leak_interior, scores.leak_edge, scores.false_interior, scores.false_edge];
    assert_eq!(found, [one; 4]);
    // Edges of the centre truth are all there is here.
    assert_eq!([scores.leak_interior_strict, scores.false_interior_strict], [one; 2]);
}

#[test]
fn a_shadow_thinner_than_a_pixel_has_an_edge_too() {
    let mut truth = truth(9, &["111111111"; 9]);
    truth.area[4 * 9 + 4] = 0.6;
    let mut mask = truth.centre.clone();
    mask[4 * 9 + 4] = 0.0;
    let scores = scores(&mask, &truth);
    assert_eq!((scores.false_edge, scores.false_interior), (1.0 / 81.0, 0.0));
    assert_eq!(scores.edge_center_px, None, "the centre truth has no edge");
    // Strictly read there is no edge at all: the same pixel is interior.
    assert_eq!((scores.false_interior_strict, scores.leak_interior_strict), (1.0 / 81.0, 0.0));
}

#[test]
fn a_missing_edge_counts_as_the_search_distance_and_silhouettes_stay_out() {
    let mut truth = halves();
    let lit = vec![1.0; 16 * 12];
    assert_eq!(scores(&lit, &truth).edge_center_px, Some(f64::from(EDGE_SEARCH_PX)));
    // An edge the other way round is not the same edge.
    let turned: Vec<f32> = truth.centre.iter().map(|value| 1.0 - value).collect();
    assert_eq!(scores(&turned, &truth).edge_center_px, Some(f64::from(EDGE_SEARCH_PX)));
    // Cut the surface along the edge: nothing is left to be displaced.
    (0..12).for_each(|row| truth.joins[row * 16 + 7] &= !JOINS_RIGHT);
    assert_eq!(scores(&lit, &truth).edge_center_px, None);
}

#[test]
fn a_soft_edge_lies_where_it_crosses_a_half() {
    let truth = halves();
    let mut mask = truth.centre.clone();
    // From 0.25 at column 7 to 0.75 at column 8, ½ is half-way; to 1 it is a third of the way: 1/6 px off.
    (0..12).for_each(|row| (mask[row * 16 + 7], mask[row * 16 + 8]) = (0.25, 0.75));
    assert_eq!(scores(&mask, &truth).edge_center_px, Some(0.0));
    (0..12).for_each(|row| mask[row * 16 + 8] = 1.0);
    assert!((scores(&mask, &truth).edge_center_px.unwrap() - 1.0 / 6.0).abs() < 1e-6);
}

#[test]
fn what_is_not_valid_does_not_count() {
    let mut truth = halves();
    (0..16 * 12).filter(|index| index % 16 < 8).for_each(|index| truth.valid[index] = false);
    let scores = scores(&[1.0; 16 * 12], &truth);
    assert_eq!((scores.valid_pixels, scores.mae, scores.wrong_center), (96, 0.0, 0.0));
    let nothing =
        Scores::new(&[1.0; 4], &Truth { valid: vec![false; 4], ..super::tests::truth(2, &["11", "11"]) }).unwrap();
    assert_eq!((nothing.rmse, nothing.valid_pixels, nothing.edge_center_px), (0.0, 0, None));
}

#[test]
fn thirds_are_of_equal_count_by_depth() {
    let truth = halves();
    let mut mask = truth.centre.clone();
    // Rows 4 to 7 are the middle third; one wrong pixel in it, half a wrong one in the last.
    (mask[5 * 16], mask[11 * 16]) = (1.0, 0.5);
    let thirds = scores(&mask, &truth).thirds;
    assert_eq!(thirds.map(|third| third.depth_min), [1.0, 5.0, 9.0]);
    assert_eq!(thirds.map(|third| third.depth_max), [4.0, 8.0, 12.0]);
    assert_eq!(thirds.map(|third| third.mae), [0.0, 1.0 / 64.0, 0.5 / 64.0]);
    assert_eq!(thirds.map(|third| third.rmse), [0.0, 0.125, 0.0625]);
    assert_eq!(thirds.map(|third| third.wrong_center), [0.0, 1.0 / 64.0, 0.0]);
}

#[test]
fn flicker_is_change_that_the_truth_does_not_have() {
    let (before, after) = (halves(), truth(16, &["0000000001111111"; 12]));
    // The mask that moves with the truth does not flicker; the one that stays does, as does one that jumps alone.
    assert_eq!(flicker((&before.centre, &before), (&after.centre, &after)), Ok(0.0));
    assert_eq!(flicker((&before.centre, &before), (&before.centre, &after)), Ok(1.0 / 16.0));
    assert_eq!(flicker((&moved(7), &before), (&moved(9), &before)), Ok(2.0 / 16.0));
    // A constant error is no flicker.
    assert_eq!(flicker((&moved(3), &before), (&moved(3), &before)), Ok(0.0));
    // Pixels that are not valid in both pictures do not count.
    let mut gone = before.clone();
    gone.valid[..16 * 12].iter_mut().enumerate().for_each(|(index, valid)| *valid = index % 16 != 7);
    assert_eq!(flicker((&moved(8), &before), (&moved(7), &gone)), Ok(0.0));
}

#[test]
fn masks_that_do_not_fit_are_refused() {
    let truth = halves();
    let size = MaskError::Size { expected: 192, got: 3 };
    assert_eq!(Scores::new(&[1.0; 3], &truth), Err(size));
    assert_eq!(heat_map(&[1.0; 3], &truth), Err(size));
    assert_eq!(flicker((&[1.0; 3], &truth), (&truth.centre, &truth)), Err(size));
    assert_eq!(size.to_string(), "mask has 3 pixels; legal is 192, as the truth has");
    for bad in [f32::NAN, -0.1, 1.5] {
        let mut mask = truth.centre.clone();
        mask[7] = bad;
        let error = Scores::new(&mask, &truth).unwrap_err();
        assert!(matches!(error, MaskError::Value { index: 7, .. }), "{error}");
    }
}

#[test]
fn the_heat_map_is_red_for_leaks_and_blue_for_false_shadow() {
    let mut truth = halves();
    truth.valid[0] = false;
    let mut mask = truth.centre.clone();
    (mask[1], mask[9]) = (1.0, 0.0);
    let map = heat_map(&mask, &truth).unwrap();
    let colour = |pixel: usize| &map[pixel * 3..pixel * 3 + 3];
    assert_eq!(map.len(), 192 * 3);
    assert_eq!((colour(0), colour(1), colour(9)), (&[24, 24, 28][..], &[255, 96, 32][..], &[48, 128, 255][..]));
    assert_eq!((colour(2), colour(10)), (&[48, 48, 48][..], &[128, 128, 128][..]));
}

#[test]
fn bytes_become_the_unit_range() {
    assert_eq!(mask_from_bytes(&[0, 51, 255]), [0.0, 0.2, 1.0]);
}

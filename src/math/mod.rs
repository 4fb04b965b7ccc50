//! Mathematics without an opinion about shadows: typed spaces, exact convex clipping, homographies, smallest
//! rectangles, searches.

pub(crate) mod convex;
pub mod homography;
pub(crate) mod rectangle;
pub(crate) mod search;
pub(crate) mod space;

//! The composite: stages in order.

use crate::content::Tile;
use crate::encoding::stage::Encoding;
use crate::error::FitError;
use crate::fit::bias::Bias;
use crate::fit::blur;
use crate::fit::layout::How;
use crate::fit::share::Share;
use crate::fit::snap::Stabilise;
use crate::fit::view::{Fitter, Texels};
use crate::focus::FocusBody;
use crate::frame::{MapShape, ShadowFrame, WgslKey};
use crate::grazing::Grazing;
use crate::report::{LeftOut, Part, Why};
use crate::split::Split;
use crate::technique::{FitInput, ShadowTechnique};
use crate::warp::Warp;

/// What depth the texels of a warped map hold. Uniform maps hold linear depth either way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthLaw {
    /// Linear along the light, in every texel: casters of warped maps write it in a fragment shader. A plane across the
    /// light has no slope, so that its bias is as small as in a uniform map.
    #[default]
    Linear,
    /// Linear depth over w, as the rasteriser makes it: early depth tests and the hardware's bias work, and casters
    /// need no fragment shader. Depth falls where w grows, so that the bias grows by as much: contacts leak more the
    /// stronger the warp.
    Projective,
}

/// A technique, as a choice of stages. Every combination is legal; the named ones are in
/// [`techniques`](crate::techniques).
///
/// ```
/// use antumbra::{Encoding, Pcf, Remix, Stabilise};
/// let soft_and_still = Remix { encoding: Encoding::Depth(Pcf::Box5x5), stabilise: Stabilise::SnapTexels, ..Remix::default() };
/// # let _ = soft_and_still;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remix {
    /// How many maps there are, and what each is for. Default: one.
    pub split: Split,
    /// Layout of a map. Default: least error, which is the focused map where no warp pays.
    pub warp: Warp,
    /// What is stored and how it is read. Default: hardware 2×2, one texture sample.
    pub encoding: Encoding,
    /// What depth a texel holds. Default: linear.
    pub depth: DepthLaw,
    /// Default: automatic.
    pub bias: Bias,
    /// How many of the texels each of several maps gets. Default: equal shares.
    pub share: Share,
    /// Default: off, the sharpest.
    pub stabilise: Stabilise,
    /// Limits published warps to the strength that is predicted to be no worse than uniform. Default: on; off
    /// reproduces the papers. Least-error and fixed strengths are what they are either way.
    pub guard: bool,
    /// What stands in for the maps where the light grazes a surface. Default: off, maps say what they see.
    pub grazing: Grazing,
}

impl Default for Remix {
    fn default() -> Self {
        Self {
            split: Split::default(),
            warp: Warp::default(),
            encoding: Encoding::default(),
            depth: DepthLaw::default(),
            bias: Bias::default(),
            share: Share::default(),
            stabilise: Stabilise::default(),
            guard: true,
            grazing: Grazing::Off,
        }
    }
}

impl ShadowTechnique for Remix {
    fn wgsl_key(&self) -> WgslKey {
        let (texel, filter) = self.encoding.key();
        let warped = self.warp.bends() && self.stabilise == Stabilise::Off;
        let shape = match (warped, self.depth) {
            (false, _) => MapShape::Affine,
            (true, DepthLaw::Linear) => MapShape::Projective,
            (true, DepthLaw::Projective) => MapShape::ProjectiveDepth,
        };
        let (select, blend) = self.split.selection();
        WgslKey { texel, filter, shape, maps: self.split.maps(), select, blend, grazing: self.grazing }
    }

    fn fit(&self, input: &FitInput) -> Result<ShadowFrame, FitError> {
        // Check the inputs at the door.
        let input = input.validate()?;
        self.bias.validate()?;
        self.warp.validate()?;
        self.split.validate()?;
        self.encoding.validate()?;
        let travel = input.light.directional()?;
        let mut frame = ShadowFrame::lit(self.wgsl_key(), input.map);
        // Find what has to be in the map.
        let body = match self.warp {
            Warp::Uniform => FocusBody::of_scene(&input.scene, travel, input.origin),
            _ => FocusBody::of_view(&input.camera, &input.scene, travel, input.origin),
        };
        let mut body = match body {
            Ok(body) => body,
            Err(LeftOut { part, why }) => {
                frame.leave_out(part, why);
                return Ok(frame);
            }
        };
        body.left_out.iter().for_each(|cut| frame.leave_out(cut.part, cut.why));
        // Lay it out, and draw the conclusions: views and uniforms.
        let texels = Texels::of(input.map.side, frame.wgsl.filter);
        let how = How { warp: self.warp, guard: self.guard, stabilise: self.stabilise, share: self.share };
        let tile = Tile::whole(0, input.map.side);
        let (bias, encoding) = (self.bias, self.encoding);
        let fitter = Fitter { input: &input, travel, tile, texels, bias, encoding, how, index: 0, split: 0 };
        blur::report(&self.encoding, &mut frame);
        match self.split {
            Split::Depth(splits) if splits.maps > 1 && self.warp != Warp::Uniform => {
                fitter.slices(&body, &splits, &mut frame);
            }
            split => {
                let fitter = Fitter { texels: fitter.texels_for(&body, input.map.side), ..fitter };
                let said = frame.left_out.len();
                let layout = fitter.lay_out(&mut body, &mut frame);
                if let Err(why) = fitter.view(&body, &layout, &mut frame) {
                    frame.left_out.truncate(said);
                    frame.leave_out(Part::Light, why);
                    return Ok(frame);
                }
                // A map of the whole scene is the same for every slice.
                (1..split.maps()).for_each(|split| frame.leave_out(Part::Split(split), Why::ServedBy { view: 0 }));
                Fitter::finish_one(split, &mut frame);
            }
        }
        Ok(frame)
    }
}

//! A tick of players who are alone in their worlds, several blocks of lanes at a time.
//!
//! A block's tick is long chains of instructions that wait for each other. Where no branch is guessed
//! wrong the chains of several blocks overlap in the processor; so what has no branch on numbers is done
//! for all blocks in a row, and those few players who need a closer look are gathered from all of them
//! into full blocks.

use super::stage::{Body, Stage};
use crate::input::Input;
use crate::movement::Movement;
use crate::player::Player;
use crate::real::{Int, Mask, Real, Scalar, V3, Work};
use crate::rules::Rules;
use crate::scene::Scene;
use crate::terrain::Surface;
use crate::tick::{go, push};
use core::marker::PhantomData;

/// Players that are ticked side by side, where they have lanes: enough to fill the blocks that the late
/// ones are gathered into, few enough to stay in the first cache.
pub(super) const PLAYERS: usize = 256;

/// The most blocks that they are; single players are blocks of one.
pub(super) const MOST_BLOCKS: usize = 32;

/// Blocks that are ticked side by side.
pub(super) const fn together<R: Real>() -> usize {
    if R::LANES == 1 { 8 } else { PLAYERS / R::LANES }
}

/// Whether those who meet nothing are moved first: one player alone is done sooner with one look than
/// with two.
pub(super) const fn passes<M: Movement, R: Real>() -> bool {
    M::PASSES_FROM <= R::LANES
}

/// Ticks of players who are alone in their worlds, with the same inputs.
struct PlayAlone<'a, S: Scene, M: Movement, R: Real> {
    stage: &'a Stage<'a, R::Scalar>,
    bodies: &'a mut [Body<S, R>],
    inputs: &'a [Input<R>],
    ticks: u32,
    movement: PhantomData<M>,
}

impl<S: Scene, M: Movement, R: Real> Work for PlayAlone<'_, S, M, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for _ in 0..self.ticks {
            self.stage.tick_alone::<S, M, R>(self.bodies, self.inputs);
        }
    }
}

impl<T: Scalar> Stage<'_, T> {
    /// Ticks of at most [`together`] blocks. Compiled once for each scene, tier and lane width, whoever calls.
    #[inline(never)]
    pub(super) fn play_alone<S: Scene, M: Movement, R: Real<Scalar = T>>(
        &self,
        bodies: &mut [Body<S, R>],
        inputs: &[Input<R>],
        ticks: u32,
    ) {
        R::enter(PlayAlone::<S, M, R> { stage: self, bodies, inputs, ticks, movement: PhantomData });
    }

    /// A tick of at most [`together`] blocks.
    #[inline(always)]
    fn tick_alone<S: Scene, M: Movement, R: Real<Scalar = T>>(
        &self,
        bodies: &mut [Body<S, R>],
        inputs: &[Input<R>],
    ) {
        let passes = passes::<M, R>();
        let mut velocity = [V3::zero(); MOST_BLOCKS];
        let mut passed = [R::Mask::splat(false); MOST_BLOCKS];
        // Who is near a solid makes the whole tick anew, alone; the other lanes never notice.
        let mut near = [R::Mask::splat(false); MOST_BLOCKS];
        let mut saved: Vec<Body<S, R>> = Vec::new();
        for (k, (body, input)) in bodies.iter_mut().zip(inputs).enumerate() {
            self.aim(body, input);
            #[cfg(feature = "solids")]
            if S::SOLIDS {
                near[k] = self.near_solids(body);
                if near[k].any() {
                    saved.push(*body);
                }
            }
            velocity[k] = push::<S, M, R>(&mut body.player, input, self.rules);
            if passes {
                passed[k] = M::pass(&mut body.player, &self.surface, self.rules);
            }
        }
        if passes {
            catch_up::<S, M, R>(bodies, &passed, &self.surface, self.rules);
        }
        let mut saved = saved.into_iter();
        for (k, (body, input)) in bodies.iter_mut().zip(inputs).enumerate() {
            let alone = S::SOLIDS && near[k].any();
            if R::LANES > 1 || !alone {
                if !passes {
                    go::<S, M, R, _>(&mut body.player, velocity[k], &self.surface, self.rules);
                }
                self.land(body, &self.surface);
            }
            #[cfg(feature = "solids")]
            if alone && let Some(before) = saved.next() {
                for lane in (0..R::LANES).filter(|&lane| near[k].lane(lane)) {
                    let mut one = before.lane(lane);
                    self.play_near::<S, M>(&mut one, &input.lane(lane));
                    body.set_lane(lane, &one);
                }
            }
        }
    }
}

/// Moves those who have not passed, gathered into full blocks.
#[inline(always)]
pub(super) fn catch_up<S: Scene, M: Movement, R: Real>(
    blocks: &mut [impl AsMut<Player<S, R>> + AsRef<Player<S, R>>],
    passed: &[R::Mask; MOST_BLOCKS],
    surface: &Surface<'_, R::Scalar>,
    rules: &Rules<R::Scalar>,
) {
    let mut late = [(0u8, 0u8); PLAYERS];
    let mut count = 0;
    for (block, passed) in passed.iter().enumerate().take(blocks.len()) {
        let mut bits = passed.not().bits();
        while bits != 0 {
            late[count] = (block as u8, bits.trailing_zeros() as u8);
            bits &= bits - 1;
            count += 1;
        }
    }
    // Whoever stands still makes no move: so do the lanes that nobody fills.
    let mut gathered = Player::<S, R>::new(rules, V3::zero(), R::Int::splat(0));
    for late in late[..count].chunks(R::LANES) {
        for (lane, &(block, there)) in late.iter().enumerate() {
            gathered.copy_move(lane, blocks[usize::from(block)].as_ref(), usize::from(there));
        }
        for lane in late.len()..R::LANES {
            gathered.velocity.set_lane(lane, V3::zero());
        }
        M::advance(&mut gathered, V3::zero(), surface, rules);
        for (lane, &(block, there)) in late.iter().enumerate() {
            blocks[usize::from(block)].as_mut().copy_move(usize::from(there), &gathered, lane);
        }
    }
}

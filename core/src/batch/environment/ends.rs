//! What is rare in a step, player by player: ends and beginnings of episodes; and what is said of each.

use super::block::Block;
use super::decision::Decision;
use super::*;
use crate::task::seconds;
use crate::terrain::Surface;

impl<S: Scene, K: Kind, M: Movement, R: Real> Batch<S, K, M, R> {
    /// Begins the next episode of an environment.
    fn go_on(&self, (body, block): (&mut Body<S, R>, &mut Block<K, R>), lane: usize) {
        let next = self.following(&block.one(body, lane));
        let next = self
            .begin(next, &CourseRequest::default())
            .expect("a course drawn within a checked area can always begin");
        block.put(body, lane, &next, &self.setup.maps);
    }

    /// Begins the next episode of those whose last one was over before this step.
    #[inline(never)]
    pub(super) fn go_on_where_over(
        &self,
        (body, block): (&mut Body<S, R>, &mut Block<K, R>),
        decision: &Decision<R>,
        players: usize,
    ) {
        for lane in (0..players).filter(|&lane| !decision.played.lane(lane)) {
            self.go_on((&mut *body, &mut *block), lane);
        }
    }

    /// Reports the episodes that ended in this step; where the next ones begin in it, begins them and
    /// writes their observations.
    #[inline(never)]
    pub(super) fn report_ends(
        &self,
        (body, block): (&mut Body<S, R>, &mut Block<K, R>),
        first: usize,
        decision: &Decision<R>,
        rows: &mut [f32],
        report: &mut Report,
    ) {
        for (lane, row) in rows.chunks_exact_mut(self.row).enumerate() {
            if !decision.over().lane(lane) {
                continue;
            }
            report.outcomes.push((first + lane, self.outcome(&block.one(body, lane), decision, lane)));
            report.observations.extend_from_slice(row);
            if self.setup.autoreset == Autoreset::SameStep {
                self.go_on((&mut *body, &mut *block), lane);
                self.observe_one(body, block, lane, row);
            }
        }
    }

    fn outcome(&self, begun: &Begun<S, K, R::Scalar>, decision: &Decision<R>, lane: usize) -> Outcome {
        let Begun { body, run, episode: e } = begun;
        let Status { distance, speed, time, outside, .. } = self.describe(begun);
        let flag = run.flag.as_ref();
        let path = run.path.to_f64();
        Outcome {
            success: decision.arrived.lane(lane),
            death: decision.died.lane(lane),
            timeout: decision.timed_out.lane(lane),
            time,
            total_reward: e.total_reward,
            length: e.length,
            top_speed: run.top_speed.to_f64(),
            mean_speed: path / time,
            path,
            damage: body.player.damage.get(R::Scalar::default()).to_f64(),
            distance,
            start_distance: e.start_distance,
            speed,
            outside,
            terrain: i64::from(e.map),
            seed: e.seed,
            episode: e.episode,
            rise: e.rise,
            carried: flag.is_some_and(|flag| flag.carried),
            taken: flag.map_or(0, |flag| i64::from(flag.taken)),
            level: i64::from(e.level),
        }
    }

    /// What is reported of an environment at any time.
    pub(super) fn describe(&self, begun: &Begun<S, K, R::Scalar>) -> Status {
        let surface = self.setup.maps.surface::<R::Scalar>();
        let (p, run) = (&begun.body.player, &begun.run);
        let terrain = begun.episode.map as usize;
        Status {
            distance: run.distance(p, &surface).to_f64(),
            speed: p.velocity.length().to_f64(),
            time: run.seconds(self.rules.tick_ms),
            outside: !self.setup.pitches[terrain].area.contains(place(&self.setup.maps, p).truncate().into()),
            terrain,
        }
    }

    /// The same of the first players of a block, as columns from `at` on.
    #[inline(always)]
    pub(super) fn write_status(
        &self,
        (body, block): (&Body<S, R>, &Block<K, R>),
        surface: &Surface<'_, R::Scalar>,
        (at, players): (usize, usize),
        status: &mut StatusOutput<'_>,
    ) {
        let (p, run) = (&body.player, &block.run);
        let maps = &self.setup.maps;
        let distances = run.distance(p, surface).unpack();
        let speeds = p.velocity.length().unpack();
        let (x, y) = (p.position.x.unpack(), p.position.y.unpack());
        let (tile_x, tile_y, ticks) =
            (R::unpack_int(p.tile_x), R::unpack_int(p.tile_y), R::unpack_int(run.ticks));
        for lane in 0..players {
            status.distance[at + lane] = distances.as_ref()[lane].to_f64();
            status.speed[at + lane] = speeds.as_ref()[lane].to_f64();
            status.time[at + lane] = seconds(ticks.as_ref()[lane], self.rules.tick_ms);
            let local = DVec3::new(x.as_ref()[lane].to_f64(), y.as_ref()[lane].to_f64(), 0.0);
            let world = maps.to_world(local, IVec2::new(tile_x.as_ref()[lane], tile_y.as_ref()[lane]));
            let area = &self.setup.pitches[block.episodes.map.as_ref()[lane] as usize].area;
            status.outside[at + lane] = !area.contains(world.truncate().into());
        }
    }
}

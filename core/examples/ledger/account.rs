//! What each part of a tick does to a player's energy, per kg, each from its own definition: nothing here is
//! what the others leave over. The account follows the tick in the tier's own arithmetic beside the kernel,
//! and [`Account::after_forces`] and [`Account::after_move`] hold its velocity to the kernel's, bit by bit.

use discjump_core::armor::{GRAVITY, JUMP_GRACE_MS, OUTWARD_PUSH, SLICE};
use discjump_core::forces;
use discjump_core::input::Input;
use discjump_core::player::Player;
use discjump_core::real::{Scalar, V3};
use discjump_core::rules::Rules;
use discjump_core::scene::{Has, Sandbox};

use crate::witness::Sweep;

/// The player that accounts are kept of.
pub type Body<T> = Player<Sandbox, T>;

/// How many terms there are.
pub const TERMS: usize = 9;

/// Where energy comes from and goes. A force's work in a tick is its impulse times the mean of the
/// velocities before and after all of them, which is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Term {
    /// Jumps.
    Jump,
    /// Burning jets.
    Jets,
    /// Explosions.
    Blast,
    /// Ground friction, which is also walking.
    Friction,
    /// Contacts: half the square of the speed into the surface, I^2 / 2, which is lost.
    Landing,
    /// The outward push of a contact: half of 0.001 m/s squared.
    Push,
    /// What semi-implicit Euler makes of gravity: its work on the velocity, and g v dt for the height at the
    /// velocity it leaves. In free flight g^2 dt^2 / 2 is lost in every tick.
    Euler,
    /// Height that a tick with contacts moves otherwise than at the velocity of its forces: slices made
    /// again, moves after a contact, time that the bump limit drops.
    Slices,
    /// The stop rule: what speed is left, and the way back.
    Stop,
}

impl Term {
    /// All, in the order of their numbers, and what tables call them.
    pub const ALL: [(Self, &'static str); TERMS] = [
        (Self::Jump, "jumps"),
        (Self::Jets, "jets"),
        (Self::Blast, "explosions"),
        (Self::Friction, "friction and walking"),
        (Self::Landing, "contacts"),
        (Self::Push, "outward push"),
        (Self::Euler, "gravity by ticks"),
        (Self::Slices, "height of ticks with contacts"),
        (Self::Stop, "stop rule"),
    ];
}

fn floats<T: Scalar>(v: V3<T>) -> [f64; 3] {
    [v.x, v.y, v.z].map(T::to_f64)
}

/// Work of an impulse on a velocity that goes from `a` to `b` meanwhile.
fn work<T: Scalar>(impulse: V3<T>, a: V3<T>, b: V3<T>) -> f64 {
    let (dv, a, b) = (floats(impulse), floats(a), floats(b));
    (0..3).map(|k| dv[k] * 0.5 * (a[k] + b[k])).sum()
}

/// Kinetic and potential energy, J/kg.
pub fn energy<T: Scalar>(p: &Body<T>) -> f64 {
    let v = floats(p.velocity);
    0.5 * v.iter().map(|x| x * x).sum::<f64>() - GRAVITY * p.position.z.to_f64()
}

/// How a tier uses the answers to its sweeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Section 5.2: each sweep is one slice; one that hits is not made.
    Sliced,
    /// Section 5.1: each sweep is all that is left of the tick; one that hits is redone in its last slice.
    Swept,
}

/// The account of one tick.
pub struct Account<'a, T: Scalar> {
    rules: &'a Rules<T>,
    form: Form,
    velocity: V3<T>,
    /// J/kg by [`Term`].
    pub terms: [f64; TERMS],
}

impl<'a, T: Scalar> Account<'a, T> {
    /// Before a tick.
    pub fn new(p: &Body<T>, rules: &'a Rules<T>, form: Form) -> Self {
        Self { rules, form, velocity: p.velocity, terms: [0.0; TERMS] }
    }

    fn add(&mut self, term: Term, joules: f64) {
        self.terms[term as usize] += joules;
    }

    /// An impulse by itself.
    fn push(&mut self, term: Term, impulse: V3<T>) {
        let before = self.velocity;
        self.velocity = before + impulse;
        self.add(term, work(impulse, before, self.velocity));
    }

    /// A blast's impulse.
    pub fn blast(&mut self, impulse: V3<T>) {
        self.push(Term::Blast, impulse);
    }

    /// Jump, gravity, jets and friction (section 3.1, steps 1 to 7) of a player who has turned his view
    /// already: `p` before, `after` as the kernel leaves him.
    ///
    /// # Panics
    /// If the kernel's velocity has other bits.
    pub fn after_forces(&mut self, p: &Body<T>, input: &Input<T>, after: &Body<T>) {
        let rules = self.rules;
        let wish = forces::wish(input.forward, input.strafe, p.yaw, rules);
        let (Has(mut contact), Has(jetting), Has(energy)) = (p.contact, p.jetting, p.energy);
        let burns = forces::jets_burn(input.jet, jetting, energy, rules);
        if input.jump && contact.age < JUMP_GRACE_MS {
            self.push(Term::Jump, forces::jump(contact.normal, &wish, rules));
            contact.age = JUMP_GRACE_MS;
        }

        let fall = V3::new(T::zero(), T::zero(), rules.fall);
        let thrust = if burns {
            forces::jet(self.velocity, &wish, contact.age < JUMP_GRACE_MS, rules)
        } else {
            V3::zero()
        };
        let before = self.velocity;
        self.velocity = before + if burns { fall + thrust } else { fall };
        self.add(Term::Jets, work(thrust, before, self.velocity));
        let climb = -GRAVITY * rules.dt.to_f64() * self.velocity.z.to_f64();
        self.add(Term::Euler, work(fall, before, self.velocity) + climb);

        if p.touched {
            let (walk, _) = forces::friction(self.velocity, &wish, p.friction, rules);
            self.push(Term::Friction, walk);
        }
        assert!(floats(self.velocity) == floats(after.velocity), "forces: the account is not the kernel's");
    }

    /// The move: `sweeps` are all that it asked for, `after` is the player at its end.
    ///
    /// # Panics
    /// If the kernel's velocity has other bits.
    pub fn after_move(&mut self, sweeps: &[Sweep<T>], after: &Body<T>) {
        let dt = self.rules.dt;
        let wanted = self.velocity.z * dt;
        let mut left = dt;
        // Height gained so far, and where the slices of this bump began.
        let (mut risen, mut begin) = (0.0, 0.0);
        for sweep in sweeps {
            let old = self.velocity;
            if !sweep.hit.hit {
                risen += sweep.path.z.to_f64();
                continue;
            }
            self.bounce(&sweep.hit.normal);
            if self.form == Form::Swept {
                begin = risen;
                let used = sweep.hit.fraction * left;
                let slices = ((old.length() * left).to_f64() / SLICE).ceil();
                let slice = left / T::from_f64(slices);
                let full = slice * T::from_f64((used / slice).to_f64().ceil() - 1.0);
                let again = old.z * full + self.velocity.z * (used - full);
                risen += again.to_f64();
                left = left - used;
            }
            let stops = self.velocity.length() > T::zero() && floats(after.velocity) == [0.0; 3];
            if stops && core::ptr::eq(sweep, &raw const sweeps[sweeps.len() - 1]) {
                let v = floats(self.velocity);
                self.add(Term::Stop, -0.5 * v.iter().map(|x| x * x).sum::<f64>());
                self.add(Term::Stop, -GRAVITY * (begin - risen));
                self.velocity = V3::zero();
            }
            begin = if self.form == Form::Sliced { risen } else { begin };
        }
        // The way back of the stop rule is its own.
        let height = risen - wanted.to_f64();
        self.add(Term::Slices, -GRAVITY * height);
        assert!(floats(self.velocity) == floats(after.velocity), "move: the account is not the kernel's");
    }

    /// v += n (I + push), with I = -v.n.
    fn bounce(&mut self, normal: &V3<T>) {
        let impact = -self.velocity.dot(*normal);
        self.velocity = self.velocity + *normal * (impact + T::from_f64(OUTWARD_PUSH));
        self.add(Term::Landing, -0.5 * impact.to_f64().powi(2));
        self.add(Term::Push, 0.5 * OUTWARD_PUSH * OUTWARD_PUSH);
    }
}

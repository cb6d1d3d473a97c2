//! The inertia that joints and drives feel, and the longest steps that follow from it.

use crate::mechanism::{Actuator, Attachment, Bearing, Drive, JointIndex, Mechanism, Revolute};

impl Mechanism {
    /// Mass in kg that the two bodies of a revolute joint oppose to a hit, in the direction in which
    /// they give way most easily: `1/m = Σ (1/m_i + r_i²/I_i)`, r the distance of the joint from the
    /// centre of mass.
    pub fn joint_mass(&self, joint: &Revolute) -> f64 {
        1.0 / (self.point_lightness(&joint.ring) + self.point_lightness(&joint.journal))
    }

    /// What 1 N at a point accelerates it by in m/s², in the direction in which its body gives way most
    /// easily; 0 on the ground.
    pub(in crate::mechanism) fn point_lightness(&self, attachment: &Attachment) -> f64 {
        attachment.body.map_or(0.0, |i| {
            let body = &self.bodies[i];
            1.0 / body.mass + attachment.point.norm_squared() / body.inertia
        })
    }

    /// The longest fixed step in s that resolves every clearance joint's hits at `speed` m/s and
    /// every servo, or `None` where nothing limits the step.
    pub fn longest_step(&self, speed: f64) -> Option<f64> {
        let joints = self.revolutes.iter().filter_map(|joint| {
            let Bearing::Clearance(clearance) = &joint.bearing else { return None };
            Some(clearance.law.longest_step(self.joint_mass(joint), speed))
        });
        joints.chain(self.longest_smooth_step()).reduce(f64::min)
    }

    /// The longest step in s that every servo and every load stands, or `None` where nothing limits it.
    pub fn longest_smooth_step(&self) -> Option<f64> {
        let loads = self.loads.iter().filter_map(|load| load.longest_step(self));
        loads.chain(self.longest_servo_step()).reduce(f64::min)
    }

    /// The longest step in s that every servo stands: on two bodies of reduced mass μ,
    /// `h ≤ √(μ/k_p)` and `h ≤ μ/k_d` (explicit), or `None` without servos.
    pub fn longest_servo_step(&self) -> Option<f64> {
        let servos = self.actuators.iter().filter_map(|actuator| {
            let Drive::Servo { stiffness, damping } = actuator.drive else { return None };
            let gains = [stiffness, damping];
            let [stiffness, damping] = actuator.transmission.map_or(gains, |t| t.gains(gains));
            let inertia = self.driven_inertia(actuator);
            Some((inertia / stiffness).sqrt().min(inertia / damping))
        });
        servos.reduce(f64::min)
    }

    /// What the two bodies of a driven joint oppose to its drive: the reduced mass of a prismatic joint
    /// in kg, `1/m = 1/m_1 + 1/m_2`; the reduced inertia of a revolute one in kg·m²,
    /// `1/J = 1/J_1 + 1/J_2`, each about the joint.
    pub fn driven_inertia(&self, actuator: &Actuator) -> f64 {
        match actuator.joint {
            JointIndex::Prismatic(i) => self.stroke_mass(i),
            JointIndex::Revolute(i) => 1.0 / self.joint_lightness(i),
        }
    }

    /// What 1 N or 1 N·m in a joint accelerates it by, in m/s² or rad/s².
    pub fn lightness(&self, joint: JointIndex) -> f64 {
        match joint {
            JointIndex::Prismatic(i) => 1.0 / self.stroke_mass(i),
            JointIndex::Revolute(i) => self.joint_lightness(i),
        }
    }

    /// The longest step in s that a damper of at most `damping` N·s/m or N·m·s/rad in a joint stands, or
    /// `None` where there is none; a prescribed coordinate does not heed it.
    pub fn joint_damper_step(&self, joint: JointIndex, damping: f64) -> Option<f64> {
        let prescribed =
            |actuator: &Actuator| actuator.joint == joint && actuator.drive == Drive::Prescribed;
        let rate = damping * self.lightness(joint);
        let felt = !self.actuators.iter().any(prescribed) && rate > 0.0;
        felt.then(|| 1.0 / rate)
    }

    /// Mass in kg that the two bodies of prismatic joint `index` oppose to a force along it.
    pub fn stroke_mass(&self, index: usize) -> f64 {
        let joint = &self.prismatics[index];
        let lightness =
            |attachment: &Attachment| attachment.body.map_or(0.0, |i| 1.0 / self.bodies[i].mass);
        1.0 / (lightness(&joint.base) + lightness(&joint.slider))
    }

    /// What one N·m in revolute joint `index` accelerates the joint by in rad/s², each body turning about
    /// the joint by itself: `Σ 1/(I + m r²)`, r the distance of the joint from the centre of mass.
    pub fn joint_lightness(&self, index: usize) -> f64 {
        let joint = &self.revolutes[index];
        let lightness = |attachment: &Attachment| {
            attachment.body.map_or(0.0, |i| {
                let body = &self.bodies[i];
                1.0 / (body.inertia + body.mass * attachment.point.norm_squared())
            })
        };
        lightness(&joint.ring) + lightness(&joint.journal)
    }

    /// The longest step in s that a damper of at most `damping` N·s/m along prismatic joint `index`
    /// stands, or `None` where there is none; a prescribed length does not heed it.
    pub fn rod_damper_step(&self, index: usize, damping: f64) -> Option<f64> {
        let prescribed = |actuator: &Actuator| {
            actuator.joint == JointIndex::Prismatic(index) && actuator.drive == Drive::Prescribed
        };
        let felt = !self.actuators.iter().any(prescribed) && damping > 0.0;
        felt.then(|| self.stroke_mass(index) / damping)
    }
}

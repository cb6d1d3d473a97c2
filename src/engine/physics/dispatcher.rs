//! Exact queries between a journal (a ball) and a bearing ring, for parry's query dispatch.

use crate::contact::circle_in_ring;
use crate::engine::{BearingRing, from_rapier, to_rapier};
use rapier2d_f64::math::{Pose, Real, Vector};
use rapier2d_f64::parry::query::details::{
    ContactManifoldsWorkspace, NormalConstraints, ShapeCastOptions,
};
use rapier2d_f64::parry::query::{
    ClosestPoints, Contact, ContactManifold, NonlinearRigidMotion, PersistentQueryDispatcher,
    QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection, TrackedContact, Unsupported,
};
use rapier2d_f64::parry::shape::{PackedFeatureId, Shape};

/// Answers ball-against-[`BearingRing`] queries in closed form and leaves all others to the
/// dispatcher chained after it.
#[derive(Clone, Copy, Debug, Default)]
pub struct RingDispatcher;

/// Contact of a ball and a ring in the shapes' own axes, in the order in which they were given.
struct BallInRing {
    points: [Vector; 2],
    normals: [Vector; 2],
    /// Gap c − |e| in m, negative in contact.
    distance: Real,
}

impl BallInRing {
    /// `pos12` is the pose of shape 2 in the axes of shape 1.
    fn new(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Result<Self, Unsupported> {
        if let (Some(ring), Some(ball)) = (g1.as_shape::<BearingRing>(), g2.as_ball()) {
            let clearance = ring.radius - ball.radius;
            let (penetration, normal) = circle_in_ring(from_rapier(pos12.translation), clearance);
            let out = to_rapier(normal);
            let out_in_ball = pos12.rotation.inverse() * out;
            Ok(Self {
                points: [out * ring.radius, out_in_ball * ball.radius],
                normals: [-out, out_in_ball],
                distance: -penetration,
            })
        } else if g2.as_shape::<BearingRing>().is_some() && g1.as_ball().is_some() {
            let mut swapped = Self::new(&pos12.inverse(), g2, g1)?;
            swapped.points.reverse();
            swapped.normals.reverse();
            Ok(swapped)
        } else {
            Err(Unsupported)
        }
    }
}

impl QueryDispatcher for RingDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        Ok(ShapeIntersection::new(BallInRing::new(pos12, g1, g2)?.distance <= 0.0))
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        Ok(ShapeDistance::new(BallInRing::new(pos12, g1, g2)?.distance.max(0.0)))
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        let BallInRing { points, normals, distance } = BallInRing::new(pos12, g1, g2)?;
        Ok((distance <= prediction)
            .then(|| Contact::new(points[0], points[1], normals[0], normals[1], distance)))
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        let BallInRing { points, distance, .. } = BallInRing::new(pos12, g1, g2)?;
        Ok(if distance <= 0.0 {
            ClosestPoints::Intersecting
        } else if distance <= max_dist {
            ClosestPoints::WithinMargin(points[0], points[1])
        } else {
            ClosestPoints::Disjoint
        })
    }

    /// Casts serve continuous collision detection, which is off where forces are computed.
    fn cast_shapes(
        &self,
        _: &Pose,
        _: Vector,
        _: &dyn Shape,
        _: &dyn Shape,
        _: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }

    fn cast_shapes_nonlinear(
        &self,
        _: &NonlinearRigidMotion,
        _: &dyn Shape,
        _: &NonlinearRigidMotion,
        _: &dyn Shape,
        _: Real,
        _: Real,
        _: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        Err(Unsupported)
    }
}

impl<M: Default + Clone, C: Default + Copy> PersistentQueryDispatcher<M, C> for RingDispatcher {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        _workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        if manifolds.len() != 1 {
            manifolds.clear();
            manifolds.push(ContactManifold::new());
        }
        self.contact_manifold_convex_convex(
            pos12,
            g1,
            g2,
            None,
            None,
            prediction,
            &mut manifolds[0],
        )
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        _constraints1: Option<&dyn NormalConstraints>,
        _constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        let BallInRing { points, normals, distance } = BallInRing::new(pos12, g1, g2)?;
        if distance > prediction {
            manifold.points.clear();
            return Ok(());
        }
        let feature = PackedFeatureId::face(0);
        let contact = TrackedContact::new(points[0], points[1], feature, feature, distance);
        match manifold.points.first_mut() {
            Some(point) => point.copy_geometry_from(contact),
            None => manifold.points.push(contact),
        }
        (manifold.local_n1, manifold.local_n2) = (normals[0], normals[1]);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier2d_f64::parry::shape::Ball;

    #[test]
    fn both_orders_agree_with_the_closed_form_and_with_each_other() {
        let (ring, ball) = (BearingRing { radius: 0.01 }, Ball::new(0.0095));
        let pose = Pose::new(Vector::new(3.0e-4, 4.1e-4), 0.7);
        let query = |pos12: &Pose, a: &dyn Shape, b: &dyn Shape| {
            let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
            RingDispatcher
                .contact_manifolds(pos12, a, b, 1e-3, &mut manifolds, &mut None)
                .expect("supported");
            manifolds.remove(0)
        };
        let first = query(&pose, &ring, &ball);
        let second = query(&pose.inverse(), &ball, &ring);
        let gap = 5e-4 - 3.0e-4f64.hypot(4.1e-4);
        for manifold in [&first, &second] {
            assert!((manifold.points[0].dist - gap).abs() < 1e-18);
        }
        // The two surface points lie gap apart along the normal, in the ring's axes.
        let on_ball = pose * first.points[0].local_p2;
        let apart = (on_ball - first.points[0].local_p1).dot(first.local_n1);
        assert!((apart - gap).abs() < 1e-17, "{apart} {gap}");
        assert!((second.points[0].local_p2 - first.points[0].local_p1).length() < 1e-17);
        assert!((second.local_n2 - first.local_n1).length() < 1e-15);
    }

    #[test]
    fn other_shapes_are_left_to_the_next_dispatcher() {
        let (a, b) = (Ball::new(1.0), Ball::new(1.0));
        assert!(RingDispatcher.distance(&Pose::IDENTITY, &a, &b).is_err());
    }
}

//! Systems of linear equations that are solved more than once.

use nalgebra::{DMatrix, DVector, Dyn, LU, SVD};

/// Singular values below this share of the largest are rounding of what is zero.
const ROUNDING: f64 = 1e-10;

/// A matrix, ready to be solved with: exactly where it is square, else by the smallest vector that leaves least.
#[derive(Clone, Debug)]
pub(super) enum Factors {
    Square(LU<f64, Dyn, Dyn>),
    Other(Box<SVD<f64, Dyn, Dyn>>),
}

impl Factors {
    pub fn of(matrix: DMatrix<f64>) -> Self {
        match matrix.is_square() {
            true => Self::Square(matrix.lu()),
            false => Self::Other(Box::new(matrix.svd(true, true))),
        }
    }

    /// The solution; none of a singular matrix.
    pub fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        match self {
            Self::Square(factors) => factors.solve(right),
            Self::Other(factors) => factors.solve(right, ROUNDING).ok(),
        }
    }

    /// What a right-hand side of `height` numbers, one in one of these rows by itself and zero elsewhere, leads to, side by side;
    /// none of a singular matrix.
    pub fn responses(&self, height: usize, rows: &[usize]) -> Option<DMatrix<f64>> {
        let mut right = DMatrix::zeros(height, rows.len());
        for (column, &row) in rows.iter().enumerate() {
            right[(row, column)] = 1.0;
        }
        match self {
            Self::Square(factors) => factors.solve(&right),
            Self::Other(factors) => factors.solve(&right, ROUNDING).ok(),
        }
    }
}

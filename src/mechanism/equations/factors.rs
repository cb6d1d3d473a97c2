//! Systems of linear equations that are solved more than once.

use nalgebra::{DMatrix, DVector, Dyn, LU, SVD};

/// Singular values below this share of the largest are rounding of what is zero.
const ROUNDING: f64 = 1e-10;

/// A matrix, ready to be solved with: exactly where it is square, else by the smallest vector that leaves least.
#[derive(Clone, Debug)]
pub(super) struct Factors {
    height: usize,
    decomposed: Decomposed,
}

#[derive(Clone, Debug)]
enum Decomposed {
    Square(LU<f64, Dyn, Dyn>),
    Other(Box<SVD<f64, Dyn, Dyn>>),
}

impl Factors {
    pub fn of(matrix: DMatrix<f64>) -> Self {
        let height = matrix.nrows();
        let decomposed = match matrix.is_square() {
            true => Decomposed::Square(matrix.lu()),
            false => Decomposed::Other(Box::new(matrix.svd(true, true))),
        };
        Self { height, decomposed }
    }

    /// Whether the matrix is square.
    pub fn is_square(&self) -> bool {
        matches!(self.decomposed, Decomposed::Square(_))
    }

    /// The solution; none of a singular matrix.
    pub fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        match &self.decomposed {
            Decomposed::Square(factors) => factors.solve(right),
            Decomposed::Other(factors) => factors.solve(right, ROUNDING).ok(),
        }
    }

    /// What a right-hand side that is one in one of these rows by itself and zero elsewhere leads to, side by side; none of
    /// a singular matrix.
    pub fn responses(&self, rows: &[usize]) -> Option<DMatrix<f64>> {
        let mut right = DMatrix::zeros(self.height, rows.len());
        for (column, &row) in rows.iter().enumerate() {
            right[(row, column)] = 1.0;
        }
        match &self.decomposed {
            Decomposed::Square(factors) => factors.solve(&right),
            Decomposed::Other(factors) => factors.solve(&right, ROUNDING).ok(),
        }
    }
}

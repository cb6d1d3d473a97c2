//! What tables of forces would leave of a model's residuals.

use crate::calibrate::values::instrument::Replicated;
use crate::calibrate::values::normal::{Regressed, ridged};
use crate::effects::Setting;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Residuals with effects of data that is fitted to and of data that is held back, in units of noise, and what tables change of
/// them: they are linear in their coefficients.
pub(super) struct TableFits<'a, T> {
    targets: [T; 2],
    whites: [DVector<f64>; 2],
    effects: &'a [Setting],
}

impl<'a, T: Replicated> TableFits<'a, T> {
    /// With these effects; none where there is no such machine.
    pub(super) fn of(targets: [T; 2], effects: &'a [Setting]) -> Option<Self> {
        let [on, hold] = targets.each_ref().map(|target| target.white(effects));
        Some(Self { targets, whites: [on?, hold?], effects })
    }

    /// Residuals of the data that is fitted to.
    pub(super) fn white(&self) -> &DVector<f64> {
        &self.whites[0]
    }

    /// What tables change of the residuals of the data that is fitted to, one column each.
    pub(super) fn columns(&self, tables: &[Setting]) -> Option<DMatrix<f64>> {
        self.columns_of(0, tables)
    }

    fn columns_of(&self, which: usize, tables: &[Setting]) -> Option<DMatrix<f64>> {
        let column = |table: &Setting| {
            let effects = [self.effects, std::slice::from_ref(table)].concat();
            Some(self.targets[which].white(&effects)? - &self.whites[which])
        };
        let columns = tables.par_iter().map(column).collect::<Option<Vec<_>>>()?;
        Some(DMatrix::from_columns(&columns))
    }

    /// The share that tables in `parts` of equal number remove of what stands above noise in the data that is held back, with
    /// weights that are fitted to the other data, and these.
    pub(super) fn regressed(
        &self,
        tables: &[Setting],
        parts: usize,
    ) -> Option<(f64, DVector<f64>)> {
        let [on, hold] = [self.columns_of(0, tables)?, self.columns_of(1, tables)?];
        let fits = Regressed { columns: &on, white: &self.whites[0] };
        ridged(fits, Regressed { columns: &hold, white: &self.whites[1] }, parts)
    }
}

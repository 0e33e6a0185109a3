// What the code of `LotkaVolterra` has beside that of `FreeRigidBody`.

#[allow(non_snake_case, clippy::many_single_char_names)]
impl<S: ::lie_runtime::Scalar> ::lie_runtime::Poisson<S> for LotkaVolterraSystem<S> {
    fn poisson_degree(&self) -> ::core::option::Option<u32> {
        ::core::option::Option::Some(2)
    }

    /// `out_ij = d^2H/dmu_i dmu_j`
    ///
    /// 4 multiplications, 2 divisions.
    #[inline]
    fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
        let [[_, y2, y3]] = mu.data.0;
        let _t0 = S::one() / y2;
        let _t1 = S::one() / y3;
        out.as_mut_slice().fill(S::zero());
        out[(1, 1)] = self.minus_nu * _t0 * _t0;
        out[(2, 2)] = self.mu * _t1 * _t1;
    }

    /// `out_ij = d(Pi(mu) xi)_i/dmu_j`
    ///
    /// 5 additions, 17 multiplications.
    #[inline]
    fn poisson_slope(
        &self,
        mu: &Self::State,
        xi: &Self::State,
        out: &mut Self::Jacobian,
    ) {
        let [[y1, y2, y3]] = mu.data.0;
        let [[_xi_y1, _xi_y2, _xi_y3]] = xi.data.0;
        let _t0 = y2 * _xi_y2;
        let _t1 = y3 * _xi_y3;
        let _t2 = y1 * _xi_y1;
        out[(0, 0)] = -(self.inverse_a_b * _t0) - self.inverse_a * _t1;
        out[(0, 1)] = y1 * _xi_y2 * self.minus_inverse_a_b;
        out[(0, 2)] = y1 * _xi_y3 * self.minus_inverse_a;
        out[(1, 0)] = y2 * _xi_y1 * self.inverse_a_b;
        out[(1, 1)] = self.inverse_a_b * _t2 - _t1;
        out[(1, 2)] = -(y2 * _xi_y3);
        out[(2, 0)] = y3 * _xi_y1 * self.inverse_a;
        out[(2, 1)] = y3 * _xi_y2;
        out[(2, 2)] = self.inverse_a * _t2 + _t0;
    }
}

/// The Poisson midpoint rule, unknown `u = mu1`: `u - mu - h f((mu + u)/2) = 0`.
#[derive(Clone, Debug)]
#[allow(non_snake_case)]
pub struct LotkaVolterraMidpoint<'a, S: ::lie_runtime::Scalar> {
    system: &'a LotkaVolterraSystem<S>,
    base: ::lie_runtime::__private_0_1::SVector<S, 3>,
    h: S,
    /// `h/4`
    h_over_4: S,
    /// `h/(4*a*b)`
    h_over_4_a_b: S,
    /// `h/(4*a)`
    h_over_4_a: S,
    /// `-h/4`
    minus_h_over_4: S,
    /// `-a*h/4`
    minus_a_h_over_4: S,
    /// `mu*h/2`
    mu_h_over_2: S,
    /// `-b*h/4`
    minus_b_h_over_4: S,
    /// `nu*h/2`
    nu_h_over_2: S,
    /// `nu*h/(2*a*b) - mu*h/(2*a) + 1`
    _h8: S,
    /// `-mu*h/2 + 1`
    _h9: S,
    /// `-nu*h/2 + 1`
    _h10: S,
}

/// Elimination of 3 rows in a fixed order, 0 entries of fill-in: 17 multiplications with the solution.
#[derive(Clone, Copy, Debug)]
pub struct LotkaVolterraGonzalezElimination;

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::__private_0_1::FixedElimination<
    S,
    ::lie_runtime::__private_0_1::SMatrix<S, 3, 3>,
    ::lie_runtime::__private_0_1::SVector<S, 3>,
> for LotkaVolterraGonzalezElimination {
    #[inline]
    fn factor(matrix: &mut ::lie_runtime::__private_0_1::SMatrix<S, 3, 3>) -> S::Mask {
        let _a0_0 = matrix[(0, 0)];
        let _a0_0 = S::one() / _a0_0;
        let _a1_0 = matrix[(1, 0)];
        let _a1_0 = _a1_0 * _a0_0;
        let _a0_1 = matrix[(0, 1)];
        let _a1_1 = matrix[(1, 1)];
        let _a1_1 = _a1_1 - _a1_0 * _a0_1;
        let _a0_2 = matrix[(0, 2)];
        let _a1_2 = matrix[(1, 2)];
        let _a1_2 = _a1_2 - _a1_0 * _a0_2;
        let _a2_0 = matrix[(2, 0)];
        let _a2_0 = _a2_0 * _a0_0;
        let _a2_1 = matrix[(2, 1)];
        let _a2_1 = _a2_1 - _a2_0 * _a0_1;
        let _a2_2 = matrix[(2, 2)];
        let _a2_2 = _a2_2 - _a2_0 * _a0_2;
        let _a1_1 = S::one() / _a1_1;
        let _a2_1 = _a2_1 * _a1_1;
        let _a2_2 = _a2_2 - _a2_1 * _a1_2;
        let _a2_2 = S::one() / _a2_2;
        matrix[(0, 0)] = _a0_0;
        matrix[(1, 0)] = _a1_0;
        matrix[(1, 1)] = _a1_1;
        matrix[(1, 2)] = _a1_2;
        matrix[(2, 0)] = _a2_0;
        matrix[(2, 1)] = _a2_1;
        matrix[(2, 2)] = _a2_2;
        ::lie_runtime::__private_0_1::inverse_pivots_are_safe(
            _a0_0.abs() + _a1_1.abs() + _a2_2.abs(),
        )
    }

    #[inline]
    fn solve(
        factors: &::lie_runtime::__private_0_1::SMatrix<S, 3, 3>,
        vector: &mut ::lie_runtime::__private_0_1::SVector<S, 3>,
    ) {
        let _b0 = vector[0];
        let _b1 = vector[1] - factors[(1, 0)] * _b0;
        let _b2 = vector[2] - factors[(2, 0)] * _b0 - factors[(2, 1)] * _b1;
        let _b2 = _b2 * factors[(2, 2)];
        let _b1 = (_b1 - factors[(1, 2)] * _b2) * factors[(1, 1)];
        let _b0 = (_b0 - factors[(0, 1)] * _b1 - factors[(0, 2)] * _b2)
            * factors[(0, 0)];
        vector[0] = _b0;
        vector[1] = _b1;
        vector[2] = _b2;
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::Gonzalez>
for LotkaVolterraSystem<S> {
    type Equation<'a> = ::lie_runtime::__private_0_1::Eliminated<
        ::lie_runtime::generic::DiscreteGradientStep<
            'a,
            S,
            LotkaVolterraSystem<S>,
            ::lie_runtime::generic::GonzalezGradient<S, LotkaVolterraSystem<S>>,
        >,
        LotkaVolterraGonzalezElimination,
    >
    where
        Self: 'a;
    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::Gonzalez,
        h: S,
    ) -> Self::Equation<'a> {
        ::lie_runtime::__private_0_1::Eliminated::new(
            ::lie_runtime::generic::DiscreteGradientStep::<
                S,
                _,
                ::lie_runtime::generic::GonzalezGradient<S, _>,
            >::new(self, h),
        )
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::MeanValue>
for LotkaVolterraSystem<S> {
    type Equation<'a> = ::lie_runtime::__private_0_1::Eliminated<
        ::lie_runtime::generic::DiscreteGradientStep<
            'a,
            S,
            LotkaVolterraSystem<S>,
            ::lie_runtime::generic::MeanValueGradient<S, LotkaVolterraSystem<S>>,
        >,
        LotkaVolterraGonzalezElimination,
    >
    where
        Self: 'a;
    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::MeanValue,
        h: S,
    ) -> Self::Equation<'a> {
        ::lie_runtime::__private_0_1::Eliminated::new(
            ::lie_runtime::generic::DiscreteGradientStep::<
                S,
                _,
                ::lie_runtime::generic::MeanValueGradient<S, _>,
            >::new(self, h),
        )
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::ItohAbe>
for LotkaVolterraSystem<S> {
    type Equation<'a> = ::lie_runtime::__private_0_1::Eliminated<
        ::lie_runtime::generic::DiscreteGradientStep<
            'a,
            S,
            LotkaVolterraSystem<S>,
            ::lie_runtime::generic::ItohAbeGradient<S, LotkaVolterraSystem<S>>,
        >,
        LotkaVolterraGonzalezElimination,
    >
    where
        Self: 'a;
    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::ItohAbe,
        h: S,
    ) -> Self::Equation<'a> {
        ::lie_runtime::__private_0_1::Eliminated::new(
            ::lie_runtime::generic::DiscreteGradientStep::<
                S,
                _,
                ::lie_runtime::generic::ItohAbeGradient<S, _>,
            >::new(self, h),
        )
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::CohenHairer2>
for LotkaVolterraSystem<S> {
    type Equation<'a> = ::lie_runtime::__private_0_1::Eliminated<
        ::lie_runtime::generic::DiscreteGradientStep<
            'a,
            S,
            LotkaVolterraSystem<S>,
            ::lie_runtime::generic::MeanValueGradient<S, LotkaVolterraSystem<S>>,
        >,
        LotkaVolterraGonzalezElimination,
    >
    where
        Self: 'a;
    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::CohenHairer2,
        h: S,
    ) -> Self::Equation<'a> {
        ::lie_runtime::__private_0_1::Eliminated::new(
            ::lie_runtime::generic::DiscreteGradientStep::<
                S,
                _,
                ::lie_runtime::generic::MeanValueGradient<S, _>,
            >::new(self, h),
        )
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::CohenHairer4>
for LotkaVolterraSystem<S> {
    type Equation<'a> = ::lie_runtime::__private_0_1::Eliminated<
        ::lie_runtime::generic::CohenHairerStep<'a, S, LotkaVolterraSystem<S>, 2>,
        LotkaVolterraGauss4Elimination,
    >
    where
        Self: 'a;
    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::CohenHairer4,
        h: S,
    ) -> Self::Equation<'a> {
        ::lie_runtime::__private_0_1::Eliminated::new(
            ::lie_runtime::generic::CohenHairerStep::new(self, h),
        )
    }
}

/// Elimination of 9 rows in a fixed order, 0 entries of fill-in: 321 multiplications with the solution.
#[derive(Clone, Copy, Debug)]
pub struct LotkaVolterraCohenHairer6Elimination;

impl LotkaVolterraCohenHairer6Elimination {
    const LIST: ::lie_runtime::__private_0_1::StaticElimination = ::lie_runtime::__private_0_1::StaticElimination {
        order: &[0, 1, 2, 3, 4, 5, 6, 7, 8],
        below: &[
            &[1, 2, 3, 4, 5, 6, 7, 8],
            &[2, 3, 4, 5, 6, 7, 8],
            &[3, 4, 5, 6, 7, 8],
            &[4, 5, 6, 7, 8],
            &[5, 6, 7, 8],
            &[6, 7, 8],
            &[7, 8],
            &[8],
            &[],
        ],
        right: &[
            &[1, 2, 3, 4, 5, 6, 7, 8],
            &[2, 3, 4, 5, 6, 7, 8],
            &[3, 4, 5, 6, 7, 8],
            &[4, 5, 6, 7, 8],
            &[5, 6, 7, 8],
            &[6, 7, 8],
            &[7, 8],
            &[8],
            &[],
        ],
    };
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::__private_0_1::FixedElimination<
    S,
    ::lie_runtime::__private_0_1::StageMatrix<
        ::lie_runtime::__private_0_1::SMatrix<S, 3, 3>,
        3,
    >,
    ::lie_runtime::__private_0_1::Stages<::lie_runtime::__private_0_1::SVector<S, 3>, 3>,
> for LotkaVolterraCohenHairer6Elimination {
    #[inline]
    fn factor(
        matrix: &mut ::lie_runtime::__private_0_1::StageMatrix<
            ::lie_runtime::__private_0_1::SMatrix<S, 3, 3>,
            3,
        >,
    ) -> S::Mask {
        Self::LIST.factor(matrix)
    }

    #[inline]
    fn solve(
        factors: &::lie_runtime::__private_0_1::StageMatrix<
            ::lie_runtime::__private_0_1::SMatrix<S, 3, 3>,
            3,
        >,
        vector: &mut ::lie_runtime::__private_0_1::Stages<
            ::lie_runtime::__private_0_1::SVector<S, 3>,
            3,
        >,
    ) {
        Self::LIST.solve(factors, vector);
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::CohenHairer6>
for LotkaVolterraSystem<S> {
    type Equation<'a> = ::lie_runtime::__private_0_1::Eliminated<
        ::lie_runtime::generic::CohenHairerStep<'a, S, LotkaVolterraSystem<S>, 3>,
        LotkaVolterraCohenHairer6Elimination,
    >
    where
        Self: 'a;
    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::CohenHairer6,
        h: S,
    ) -> Self::Equation<'a> {
        ::lie_runtime::__private_0_1::Eliminated::new(
            ::lie_runtime::generic::CohenHairerStep::new(self, h),
        )
    }
}

::lie_runtime::generic_equations!(
    [S : ::lie_runtime::Scalar] LotkaVolterraSystem < S >, S : gauss6, frozen_gonzalez,
    frozen_mean_value, frozen_itoh_abe, k_hj2, k_hj4, k_hj6
);

/// The flows of the pieces:
///
/// - `y2`
/// - `a*b*y1`
/// - `-a*y3`
/// - `nu*log(y2)`, `-mu*log(y3)`
#[derive(Debug)]
pub struct LotkaVolterraFound<'a, S: ::lie_runtime::Scalar> {
    #[allow(dead_code)]
    system: &'a LotkaVolterraSystem<S>,
}

#[allow(non_snake_case, clippy::many_single_char_names)]
impl<'a, S: ::lie_runtime::Scalar> LotkaVolterraFound<'a, S> {
    /// the gradient of the piece
    ///
    /// No operation.
    fn _direction0(
        &self,
        _mu: &::lie_runtime::__private_0_1::SVector<S, 3>,
        _xi: &mut ::lie_runtime::__private_0_1::SVector<S, 3>,
    ) {
        _xi.as_mut_slice().fill(S::zero());
        _xi[1] = S::one();
    }
}

impl<S: ::lie_runtime::Scalar> ::lie_runtime::PieceFlows<S>
for LotkaVolterraFound<'_, S> {
    #[inline]
    fn ascend(&mut self, first: S, t: S, mu: &mut Self::State) {
        self._flow0(first, mu);
        self._flow1(t, mu);
        self._flow2(t, mu);
    }

    #[inline]
    fn descend(&mut self, last: S, t: S, mu: &mut Self::State) {
        self._flow3(last, mu);
        self._flow2(t, mu);
        self._flow1(t, mu);
    }
}

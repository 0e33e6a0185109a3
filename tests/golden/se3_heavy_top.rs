// What the code of `HeavyTop` has beside that of `FreeRigidBody`.

#[allow(non_snake_case, clippy::many_single_char_names)]
impl<S: ::lie_runtime::Scalar> ::lie_runtime::VectorPoisson<S> for HeavyTopSystem<S> {
    fn rotation(&self) -> [usize; 3] {
        [0, 1, 2]
    }

    fn vectors(&self) -> &[[::lie_runtime::__private_0_1::Entry; 3]] {
        use ::lie_runtime::__private_0_1::entries;
        const VECTORS: &[[::lie_runtime::__private_0_1::Entry; 3]] = &[
            *entries!((3, 0, 1.0), (4, 0, 1.0), (5, 0, 1.0)),
        ];
        VECTORS
    }

    #[inline]
    fn scale(&self) -> S {
        S::one()
    }

    type Labels = ::lie_runtime::__private_0_1::SVector<S, 1>;
    fn zero_labels(&self) -> Self::Labels {
        Self::Labels::repeat(S::zero())
    }

    type Quaternions = ::lie_runtime::__private_0_1::SVector<S, 8>;
    fn zero_quaternions(&self) -> Self::Quaternions {
        Self::Quaternions::repeat(S::zero())
    }
}

impl<S: ::lie_runtime::Scalar> ::lie_runtime::CollectivePoisson<S>
for HeavyTopSystem<S> {
    type Lift = ::lie_runtime::methods::Quaternion;
}

impl HeavyTopGauss6Elimination {
    const LIST: ::lie_runtime::__private_0_1::StaticElimination = ::lie_runtime::__private_0_1::StaticElimination {
        order: &[0, 3, 6, 9, 12, 1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 15, 16, 17],
        below: &[
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[2, 4, 5, 7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[4, 5, 7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[5, 7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[8, 10, 11, 13, 14, 15, 16, 17],
            &[10, 11, 13, 14, 15, 16, 17],
            &[11, 13, 14, 15, 16, 17],
            &[13, 14, 15, 16, 17],
            &[14, 15, 16, 17],
            &[15, 16, 17],
            &[16, 17],
            &[17],
            &[],
        ],
        right: &[
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 16, 17],
            &[2, 4, 5, 7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[4, 5, 7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[5, 7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[7, 8, 10, 11, 13, 14, 15, 16, 17],
            &[8, 10, 11, 13, 14, 15, 16, 17],
            &[10, 11, 13, 14, 15, 16, 17],
            &[11, 13, 14, 15, 16, 17],
            &[13, 14, 15, 16, 17],
            &[14, 15, 16, 17],
            &[15, 16, 17],
            &[16, 17],
            &[17],
            &[],
        ],
    };
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::__private_0_1::FixedElimination<
    S,
    ::lie_runtime::__private_0_1::StageMatrix<
        ::lie_runtime::__private_0_1::SMatrix<S, 6, 6>,
        3,
    >,
    ::lie_runtime::__private_0_1::Stages<::lie_runtime::__private_0_1::SVector<S, 6>, 3>,
> for HeavyTopGauss6Elimination {
    #[inline]
    fn factor(
        matrix: &mut ::lie_runtime::__private_0_1::StageMatrix<
            ::lie_runtime::__private_0_1::SMatrix<S, 6, 6>,
            3,
        >,
    ) -> S::Mask {
        Self::LIST.factor(matrix)
    }

    #[inline]
    fn solve(
        factors: &::lie_runtime::__private_0_1::StageMatrix<
            ::lie_runtime::__private_0_1::SMatrix<S, 6, 6>,
            3,
        >,
        vector: &mut ::lie_runtime::__private_0_1::Stages<
            ::lie_runtime::__private_0_1::SVector<S, 6>,
            3,
        >,
    ) {
        Self::LIST.solve(factors, vector);
    }
}

impl<'a, S: ::lie_runtime::Scalar> HeavyTopExpMidpoint<'a, S> {
    /// All unknowns: those that the iteration leaves out by their formulas.
    ///
    /// 14 additions, 24 multiplications, 2 function calls.
    #[allow(non_snake_case)]
    fn completed(
        &self,
        unknown: &::lie_runtime::__private_0_1::SVector<S, 6>,
    ) -> ::lie_runtime::__private_0_1::SVector<S, 6> {
        let mut mu = *unknown;
        let [[_, _, _, g1, g2, g3]] = self.base.data.0;
        let [[_u_m1, _u_m2, _u_m3, _, _, _]] = unknown.data.0;
        let _t0 = _u_m2 * self.h_over_I2;
        let _t1 = _u_m3 * self.h_over_I3;
        let _t2 = g2 * _t1 - g3 * _t0;
        let _t3 = _u_m1 * self.h_over_I1;
        let _t4 = _t3 * _t3 + _t0 * _t0 + _t1 * _t1;
        let [_f0_2, _f0_3] = ::lie_runtime::closed::stumpff::<S, 2, 2>(_t4);
        let _t5 = g1 * _t0 - g2 * _t3;
        let _t6 = g3 * _t3 - g1 * _t1;
        mu[0] = _u_m1;
        mu[1] = _u_m2;
        mu[2] = _u_m3;
        mu[3] = g1 + (_t2 * _f0_2 + (_t1 * _t6 - _t0 * _t5) * _f0_3);
        mu[4] = g2 + (_t6 * _f0_2 + (_t3 * _t5 - _t1 * _t2) * _f0_3);
        mu[5] = g3 + (_t5 * _f0_2 + (_t0 * _t2 - _t3 * _t6) * _f0_3);
        mu
    }
}

#[allow(non_snake_case, clippy::many_single_char_names)]
impl<S: ::lie_runtime::Scalar> ::lie_runtime::Equation<S>
for HeavyTopExpMidpoint<'_, S> {
    #[inline]
    fn leave_out(&self, unknown: &mut Self::Unknown) {
        unknown[3] = self.base[3];
        unknown[4] = self.base[4];
        unknown[5] = self.base[5];
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::CohenHairer2>
for HeavyTopSystem<S> {
    type Equation<'a> = HeavyTopMidpoint<'a, S> where Self: 'a;

    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::CohenHairer2,
        h: S,
    ) -> Self::Equation<'a> {
        HeavyTopMidpoint::new(self, h)
    }
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::Implicit<S, ::lie_runtime::methods::CohenHairer4>
for HeavyTopSystem<S> {
    type Equation<'a> = ::lie_runtime::generic::Gauss<'a, S, HeavyTopSystem<S>, 2>
    where
        Self: 'a;
    fn equation<'a>(
        &'a self,
        _method: &::lie_runtime::methods::CohenHairer4,
        h: S,
    ) -> Self::Equation<'a> {
        ::lie_runtime::generic::Gauss::new(self, h)
    }
}

impl HeavyTopIsospectral6Elimination {
    const LIST: ::lie_runtime::__private_0_1::StaticElimination = ::lie_runtime::__private_0_1::StaticElimination {
        order: &[3, 4, 5, 9, 10, 11, 15, 16, 17, 0, 1, 2, 6, 7, 8, 12, 13, 14],
        below: &[
            &[],
            &[],
            &[],
            &[],
            &[],
            &[],
            &[],
            &[],
            &[],
            &[1, 2, 6, 7, 8, 12, 13, 14],
            &[2, 6, 7, 8, 12, 13, 14],
            &[6, 7, 8, 12, 13, 14],
            &[7, 8, 12, 13, 14],
            &[8, 12, 13, 14],
            &[12, 13, 14],
            &[13, 14],
            &[14],
            &[],
        ],
        right: &[
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[0, 1, 2, 6, 7, 8, 12, 13, 14],
            &[1, 2, 6, 7, 8, 12, 13, 14],
            &[2, 6, 7, 8, 12, 13, 14],
            &[6, 7, 8, 12, 13, 14],
            &[7, 8, 12, 13, 14],
            &[8, 12, 13, 14],
            &[12, 13, 14],
            &[13, 14],
            &[14],
            &[],
        ],
    };
}

impl<
    S: ::lie_runtime::Scalar,
> ::lie_runtime::__private_0_1::FixedElimination<
    S,
    ::lie_runtime::__private_0_1::StageMatrix<
        ::lie_runtime::__private_0_1::SMatrix<S, 6, 6>,
        3,
    >,
    ::lie_runtime::__private_0_1::Stages<::lie_runtime::__private_0_1::SVector<S, 6>, 3>,
> for HeavyTopIsospectral6Elimination {
    #[inline]
    fn factor(
        matrix: &mut ::lie_runtime::__private_0_1::StageMatrix<
            ::lie_runtime::__private_0_1::SMatrix<S, 6, 6>,
            3,
        >,
    ) -> S::Mask {
        Self::LIST.factor(matrix)
    }

    #[inline]
    fn solve(
        factors: &::lie_runtime::__private_0_1::StageMatrix<
            ::lie_runtime::__private_0_1::SMatrix<S, 6, 6>,
            3,
        >,
        vector: &mut ::lie_runtime::__private_0_1::Stages<
            ::lie_runtime::__private_0_1::SVector<S, 6>,
            3,
        >,
    ) {
        Self::LIST.solve(factors, vector);
    }
}

::lie_runtime::generic_equations!(
    [S : ::lie_runtime::Scalar] HeavyTopSystem < S >, S : gauss4, generating2,
    generating4, generating6, second_kind, generating2_cayley, generating4_cayley,
    momenta2_cayley, k_hj2_along_exp, k_hj4_along_exp, k_hj6_along_exp, collective2,
    collective4, collective6
);

#[allow(non_snake_case, clippy::many_single_char_names)]
impl<'a, S: ::lie_runtime::Scalar> HeavyTopFound<'a, S> {
    /// The flow of the piece in `m1` over a time t.
    ///
    /// `mu -> exp(s ad*_(e_i)) mu`, `s = t f_i'(mu_i)`
    ///
    /// 11 additions, 15 multiplications, 2 divisions, 1 function call.
    #[inline]
    fn _flow0_0(&self, t: S, mu: &mut ::lie_runtime::__private_0_1::SVector<S, 6>) {
        let [[m1, m2, m3, _, g2, g3]] = mu.data.0;
        let _t0 = (m1 * t * self.system.inverse_2_I1).tan();
        let _t1 = _t0 * _t0;
        let _t2 = S::one() - _t1;
        let _t3 = S::select(_t2.less(S::zero()), S::from_f64(-1.0), S::one());
        let _t4 = S::select(_t2.less(S::zero()), -(S::one() / _t0), _t0);
        let _t5 = m3 * _t3;
        let _t6 = m2 * _t3 + _t4 * _t5;
        let _t7 = _t0 * _t3 * S::from_f64(2.0) / (S::one() + _t1);
        let _t8 = _t5 - _t7 * _t6;
        let _t9 = g3 * _t3;
        let _t10 = g2 * _t3 + _t4 * _t9;
        let _t11 = _t9 - _t7 * _t10;
        mu[1] = _t6 + _t4 * _t8;
        mu[2] = _t8;
        mu[4] = _t10 + _t4 * _t11;
        mu[5] = _t11;
    }
}

impl<S: ::lie_runtime::Scalar> ::lie_runtime::PieceFlows<S> for HeavyTopFound<'_, S> {
    #[inline]
    fn ascend(&mut self, first: S, t: S, mu: &mut Self::State) {
        self._flow0(first, mu);
        self._flow1(t, mu);
    }

    #[inline]
    fn descend(&mut self, last: S, t: S, mu: &mut Self::State) {
        self._flow2(last, mu);
        self._flow1(t, mu);
    }
}

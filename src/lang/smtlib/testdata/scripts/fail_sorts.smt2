(declare-fun x () Real)
(declare-fun b () Bool)
(assert (and x b))
;? smt-sort:14: this is of sort `Real`, not `Bool`
(assert (+ x 1))
;? smt-sort:9: this is of sort `Real`, not `Bool`
(assert (< b 1))
;? smt-sort:12: a number is needed here
(assert (ite x b b))
;? smt-sort:14: this is of sort `Real`, not `Bool`
(assert (= (sin x x) 0))
;? smt-sort:12: `sin` does not take 2 arguments
(assert (forall ((y Real)) (> y x)))
;? smt-unsupported:9: quantifiers are not supported
(declare-fun f (Real) Real)
;? smt-unsupported:16: functions with arguments are not supported
(declare-fun v () (_ BitVec 8))
;? smt-unsupported:19: this sort is not supported
(get-unsat-core)
;? smt-unsupported:2: the command `get-unsat-core` is not supported
(check-sat)

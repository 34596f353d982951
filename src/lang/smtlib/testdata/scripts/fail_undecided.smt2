; ARGS: solve --solver icp
; Touching without overlap, in a way that intervals cannot separate: no claim is made.
(declare-fun x () Real [-1, 1])
(assert (> (sin (* 2 x)) (* 2 (sin x) (cos x))))
(check-sat)

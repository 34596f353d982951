; ARGS: solve --solver icp OUTPUT
(declare-fun u () Real)
(declare-fun v () Real)
(declare-fun x () Real)
(declare-fun y () Real)
(assert (= u (+ x y)))
(assert (= v (- x y)))
(assert (and (<= (- 1) x) (<= x 1) (<= (- 1) y) (<= y 1)))
(assert (> (+ (^ x 2) (^ y 2)) 3))
(check-sat)
;> unsat

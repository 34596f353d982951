; ARGS: solve OUTPUT
; Angles without bounds: one period is enough.
(declare-fun a () Real)
(declare-fun s () Real)
(push 1)
(assert (> (+ (^ (sin a) 2) (^ (cos a) 2)) 1.001))
(check-sat)
(pop 1)
(push 1)
(assert (> (+ (sin (/ a 3)) (cos (/ a 2))) 2.01))
(check-sat)
(pop 1)
(push 1)
(assert (> (sin s) 0.5))
(assert (> s 1e6))
(check-sat)
(pop 1)
;> unsat
;> unsat
;> sat

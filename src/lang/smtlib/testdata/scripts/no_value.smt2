; ARGS: solve OUTPUT
; Where a root has no value, no comparison about it holds, nor its negation.
(declare-const x Real)
(push)
(assert (< x 0))
(assert (= (^ (sqrt x) 0) 1))
(check-sat)
(pop)
(push)
(assert (< x 0))
(assert (not (= (sqrt x) (+ 1 (sqrt x)))))
(check-sat)
(pop)
(push)
(assert (not (<= (sqrt x) (sqrt x))))
(check-sat)
(pop)
(check-sat)
(get-value ((= (log x) 1) (= 1 (/ 1 0))))
;> unsat
;> unsat
;> unsat
;> sat
;> (((= 1.0 (log x)) ?)
;>  ((= 1.0 (/ 1.0 0.0)) ?))

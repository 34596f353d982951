; One script, several questions.
; expect: sat unsat
(set-logic QF_NRA)
(declare-fun speed () Real [0, 2])       ; m/s
(declare-fun turn () Real [-0.6, 0.6])   ; rad
(define-fun sideways () Real (* speed (sin turn)))
(assert (>= (* speed (cos turn)) 1.5))
(push 1)
(assert (>= sideways 0.9))
(check-sat)
(get-model)
(pop 1)
(assert (>= sideways 1.2))
(check-sat)

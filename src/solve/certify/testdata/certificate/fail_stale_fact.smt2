; ARGS: certify
; A fact about a variable that has been replaced says nothing of what comes later under its name.
(set-logic ALL)
(declare-fun x () Real)
(assert (= x 3.0))
(check-sat)
(fact (= x 3.0))
(substitute x 3.0)
(period x 10.0 20.0)
(fact (<= 10.0 x))
(search (x) ".")
;? certificate-rejected:1: box 1 of the search is not empty

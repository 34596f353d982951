; ARGS: certify OUTPUT
(declare-fun x () Real)
(declare-fun y () Real)
(assert (<= (* x x) 1.0))
(assert (<= 4.0 (+ x y)))
(assert (<= y 2.0))
(fact (<= (* x x) 1.0))
(fact (<= 2.0 x))
;? certificate-rejected:1: this does not follow from what is known
(search (x) ".")
;> error: this does not follow from what is known [certificate-rejected]
;>   --> src/solve/certify/testdata/certificate/fail_unknown_fact.smt2:8:1
;>    |
;>  8 | (fact (<= 2.0 x))
;>    | ^^^^^^^^^^^^^^^^^
;>
;> 1 error

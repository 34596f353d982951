; ARGS: certify OUTPUT
(declare-fun x () Real)
(assert (< x x))
(fact)
;? smt-syntax:1: this step is written (fact formula)
(let (x) x)
;? smt-syntax:1: this step is written (let name term)
(search x ".")
;? smt-syntax:1: this step is written (search (variables) "tree")
(substitute x)
;? smt-syntax:1: this step is written (substitute variable term)
(end now)
;? smt-syntax:1: this step is written (end)
(refute)
;? smt-unsupported:2: the command `refute` is not supported
;> error: this step is written (fact formula) [smt-syntax]
;>   --> src/solve/certify/testdata/certificate/fail_malformed.smt2:4:1
;>    |
;>  4 | (fact)
;>    | ^^^^^^
;>
;> error: this step is written (let name term) [smt-syntax]
;>   --> src/solve/certify/testdata/certificate/fail_malformed.smt2:6:1
;>    |
;>  6 | (let (x) x)
;>    | ^^^^^^^^^^^
;>
;> error: this step is written (search (variables) "tree") [smt-syntax]
;>   --> src/solve/certify/testdata/certificate/fail_malformed.smt2:8:1
;>    |
;>  8 | (search x ".")
;>    | ^^^^^^^^^^^^^^
;>
;> error: this step is written (substitute variable term) [smt-syntax]
;>   --> src/solve/certify/testdata/certificate/fail_malformed.smt2:10:1
;>    |
;> 10 | (substitute x)
;>    | ^^^^^^^^^^^^^^
;>
;> error: this step is written (end) [smt-syntax]
;>   --> src/solve/certify/testdata/certificate/fail_malformed.smt2:12:1
;>    |
;> 12 | (end now)
;>    | ^^^^^^^^^
;>
;> error: the command `refute` is not supported [smt-unsupported]
;>   --> src/solve/certify/testdata/certificate/fail_malformed.smt2:14:2
;>    |
;> 14 | (refute)
;>    |  ^^^^^^
;>
;> 6 errors

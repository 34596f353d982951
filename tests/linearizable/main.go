// Judges histories of a team's store: is each variable a register, written once in each round, whose value every robot that
// acts reads? It knows neither the protocol nor the language: what it decides is linearizability (Herlihy and Wing, 1990;
// Lowe's algorithm, as porcupine has it).
//
// It reads one history after the other on standard input, each a line of JSON: {"name": ..., "operations": [{"robot": ...,
// "key": ..., "write": ..., "value": ..., "call": ..., "return": ...}]}; and prints a line for each that is none.
package main

import (
	"bufio"
	"encoding/json"
	"fmt"
	"os"
	"time"

	"github.com/anishathalye/porcupine"
)

type operation struct {
	Robot  int
	Key    string
	Write  bool
	Value  string
	Call   int64
	Return int64
}

type history struct {
	Name       string
	Operations []operation
}

// A register: what is read is what was written last.
var register = porcupine.Model{
	Partition: func(all []porcupine.Operation) [][]porcupine.Operation {
		byKey := map[string][]porcupine.Operation{}
		for _, o := range all {
			key := o.Input.(operation).Key
			byKey[key] = append(byKey[key], o)
		}
		parts := [][]porcupine.Operation{}
		for _, part := range byKey {
			parts = append(parts, part)
		}
		return parts
	},
	Init: func() interface{} { return "" },
	Step: func(state, input, output interface{}) (bool, interface{}) {
		o := input.(operation)
		if o.Write {
			return true, o.Value
		}
		return state.(string) == o.Value, state
	},
}

func main() {
	bad, unknown, histories, operations := 0, 0, 0, 0
	lines := bufio.NewReaderSize(os.Stdin, 1<<20)
	decoder := json.NewDecoder(lines)
	for decoder.More() {
		var h history
		if err := decoder.Decode(&h); err != nil {
			fmt.Fprintln(os.Stderr, err)
			os.Exit(2)
		}
		all := []porcupine.Operation{}
		for _, o := range h.Operations {
			all = append(all, porcupine.Operation{ClientId: o.Robot, Input: o, Call: o.Call, Output: o.Value, Return: o.Return})
		}
		histories++
		operations += len(all)
		switch porcupine.CheckOperationsTimeout(register, all, time.Minute) {
		case porcupine.Illegal:
			bad++
			fmt.Println(h.Name)
		case porcupine.Unknown:
			unknown++
		}
	}
	fmt.Printf("%d histories with %d operations: %d not linearizable, %d undecided\n", histories, operations, bad, unknown)
	if bad+unknown > 0 || histories == 0 {
		os.Exit(1)
	}
}

// Blockly's Python generator on a program of as many statement blocks as ours has steps; prints one JSON line.
// Usage: node blockly.mjs COUNT REPEATS
import * as Blockly from "blockly";
import { pythonGenerator } from "blockly/python";

const [count, repeats] = [Number(process.argv[2] ?? 1000), Number(process.argv[3] ?? 20)];

const number = (value) => ({ block: { type: "math_number", fields: { NUM: value } } });
const hot = () => ({
  block: {
    type: "logic_compare",
    fields: { OP: "GT" },
    inputs: { A: { block: { type: "variables_get", fields: { VAR: { id: "temperature" } } } }, B: number(40) },
  },
});
const set = (value) => ({ type: "variables_set", fields: { VAR: { id: "temperature" } }, inputs: { VALUE: number(value) } });
const print = (value) => ({
  type: "text_print",
  inputs: { TEXT: { block: { type: "text", fields: { TEXT: `box ${value}` } } } },
});

/** Ten blocks as in bench/language.py: an If, a While and a Repeat with plain blocks inside, over and over. */
function groups() {
  const made = [];
  for (let at = 0; at < count; at += 10) {
    made.push({ type: "controls_if", inputs: { IF0: hot(), DO0: { block: chain([print(at), set(at), print(at + 1)]) } } });
    made.push({
      type: "controls_whileUntil",
      fields: { MODE: "WHILE" },
      inputs: { BOOL: hot(), DO: { block: chain([print(at), set(at)]) } },
    });
    made.push({ type: "controls_repeat_ext", inputs: { TIMES: number(3), DO: { block: chain([print(at), set(at)]) } } });
  }
  return made;
}

function chain(blocks) {
  return blocks.reduceRight((next, block) => (next ? { ...block, next: { block: next } } : block), null);
}

const workspace = new Blockly.Workspace();
const variables = [{ name: "temperature", id: "temperature" }];
Blockly.serialization.workspaces.load({ variables, blocks: { languageVersion: 0, blocks: [chain(groups())] } }, workspace);
const statements = workspace.getAllBlocks(false).filter((block) => block.previousConnection).length;
let best = Infinity;
let lines = 0;
for (let round = 0; round < repeats; round += 1) {
  const began = performance.now();
  lines = pythonGenerator.workspaceToCode(workspace).split("\n").length;
  best = Math.min(best, performance.now() - began);
}
console.log(JSON.stringify({ ms: best, statements, blocks: workspace.getAllBlocks(false).length, lines, version: Blockly.VERSION }));

/** Where a robot stands as a script begins, said by a move: pasted elsewhere it stands where other steps left it. Pure. */
import { codeOf, methodsOf, QUOTED } from "./pieces";
import { indentOf } from "./scriptLines";

const STANDS = new RegExp(
  `^( *)self\\.(\\p{ID_Continue}+) *= *(ctx\\.get\\( *${QUOTED}) *, *at *= *(${QUOTED}) *\\)$`,
  "u",
);

/** The tidied script without `at="oven01"`; what its robot picks or drops there follows a move to it. */
export function withFirstMoves(script: string): string {
  const heading = script.split("\n").findIndex((line) => /^\s*def new_task\(/.test(line));
  const moves: string[] = [];
  const lines = script.split("\n").flatMap((line) => {
    const [, indent = "", name = "", get = "", at = ""] = STANDS.exec(line) ?? [];
    if (!name) return [line];
    const given = `${indent}self.${name} = ${get})`;
    if (heading < 0 || !handlesFirst(methodsOf(script).get("new_task") ?? [], name)) return [given];
    const place = placeFor(script, `${name}_stands`);
    moves.push(`self.${name}.move(self.${place}.location)`);
    return [given, `${indent}self.${place} = ctx.get(${at})`];
  });
  const margin = " ".repeat(indentOf(lines.slice(heading + 1).find((line) => line.trim()) ?? ""));
  return [...lines.slice(0, heading + 1), ...moves.map((move) => margin + move), ...lines.slice(heading + 1)].join(
    "\n",
  );
}

/** Whether the robot picks or drops before it surely moves. */
function handlesFirst(lines: readonly string[], name: string): boolean {
  const first = lines.find((line) => codeOf(line).includes(`self.${name}.`)) ?? "";
  return first !== "" && !first.startsWith(`        self.${name}.move(`);
}

function placeFor(script: string, name: string): string {
  return script.includes(`self.${name}`) ? placeFor(script, `${name}_2`) : name;
}

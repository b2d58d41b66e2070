/** Where a robot stands as a script begins, said by a move: pasted elsewhere it stands where other steps left it. Pure. */
import { codeOf, methodsOf, namesIn, QUOTED } from "./pieces";
import { indentOf } from "./scriptLines";

const STANDS = new RegExp(
  `^( *)self\\.(\\p{ID_Continue}+) *= *(ctx\\.get\\( *${QUOTED}) *, *at *= *(${QUOTED}) *\\)$`,
  "u",
);

/** The tidied script without `at="oven01"`; what its robot picks or drops there follows a move to it. */
export function withFirstMoves(script: string): string {
  const methods = methodsOf(script);
  const moves: string[] = [];
  const lines = script.split("\n").flatMap((line) => {
    const [, indent = "", name = "", get = "", at = ""] = STANDS.exec(line) ?? [];
    if (!name) return [line];
    const given = `${indent}self.${name} = ${get})`;
    if (!handlesFirst(methods, name)) return [given];
    const place = placeFor(script, `${name}_stands`);
    moves.push(`self.${name}.move(self.${place}.location)`);
    return [given, `${indent}self.${place} = ctx.get(${at})`];
  });
  const heading = lines.findIndex((line) => /^\s*def new_task\(/.test(line));
  const margin = " ".repeat(indentOf(lines.slice(heading + 1).find((line) => line.trim()) ?? ""));
  return [...lines.slice(0, heading + 1), ...moves.map((move) => margin + move), ...lines.slice(heading + 1)].join(
    "\n",
  );
}

/** Whether the robot picks or drops before it surely moves; what a line begins or calls counts with it. */
function handlesFirst(
  methods: ReadonlyMap<string, readonly string[]>,
  name: string,
  method = "new_task",
  using = thoseUsing(methods, name),
): boolean {
  using.delete(method); // a circle of calls ends
  const isUse = (line: string) => codeOf(line).includes(`self.${name}.`);
  const begun = (line: string) => namesIn(line).filter((each) => using.has(each));
  const first = methods.get(method)?.find((line) => isUse(line) || begun(line).length > 0);
  if (first === undefined) return false;
  if (isUse(first) || !/^ {8}\S/.test(first)) return !first.startsWith(`        self.${name}.move(`);
  return begun(first).some((each) => handlesFirst(methods, name, each, using));
}

/** The methods that do something with the robot, by themselves or by what they begin. */
function thoseUsing(methods: ReadonlyMap<string, readonly string[]>, name: string): Set<string> {
  const using = new Set<string>();
  for (let before = -1; before !== using.size;) {
    before = using.size;
    for (const [each, lines] of methods) {
      const code = lines.join("\n");
      if (codeOf(code).includes(`self.${name}.`) || namesIn(code).some((inner) => using.has(inner))) using.add(each);
    }
  }
  return using;
}

function placeFor(script: string, name: string): string {
  return script.includes(`self.${name}`) ? placeFor(script, `${name}_2`) : name;
}

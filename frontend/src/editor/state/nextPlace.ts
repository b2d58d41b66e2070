/** The place where the next step goes: chosen at an open branch, and said in words. */
import { toPixels, type Point } from "@/map/plane/projection";
import { isCatch } from "@/program/document/catches";
import type { BranchRef } from "@/program/document/tree";
import { branchWord, type Link } from "@/program/scene/links";
import type { OpenProgram } from "./context";
import { useUi } from "./ui";

type Told = Pick<OpenProgram, "document" | "t">;

/** Drawing pixels around an open branch's end that belong to it: nothing that stands there is taken for its step. */
const REACH = 34;

/** "If 2, “true”"; null for the program itself, where steps go anyhow. */
export function placeWords({ document, compiled, t }: OpenProgram, { parent, branch }: BranchRef): string | null {
  const definition = document.functions[parent];
  if (definition) return t("place.function", { name: definition.name });
  const step = document.steps[parent];
  if (!step) return null;
  const said = { kind: t(`kind.${step.kind}`), number: compiled?.numbers[parent] ?? "", word: "" };
  if (branch === "body") return t("place.inside", said);
  return t("place.branch", { ...said, word: branchWord(branch, step, t) });
}

/** "draw here what is done when …", beside a branch that has no step yet. */
export function invitation({ document, t }: Told, { parent, branch }: BranchRef): string {
  const kind = document.steps[parent]?.kind ?? "";
  if (isCatch(branch)) return t("target.catch");
  if (kind === "parallel") return t("target.beside", { branch });
  return t(branch === "body" ? `target.body_${kind}` : `target.${branch}`, { defaultValue: t("target.body") });
}

/** The open branch whose end is at a point of the floor. */
export function openBranchAt(links: readonly Link[], at: Point): Link | null {
  const point = toPixels(at);
  const far = ({ points }: Link) => {
    const end = points.at(-1);
    return end ? Math.hypot(end.x - point.x, end.y - point.y) : Infinity;
  };
  const near = links.filter((link) => link.to === null && far(link) <= REACH);
  return near.sort((one, other) => far(one) - far(other))[0] ?? null;
}

export function chooseBranch({ t }: Told, link: Link): void {
  useUi.setState({ into: { branch: link.into, link: link.id, word: link.word ?? t("then") } });
}

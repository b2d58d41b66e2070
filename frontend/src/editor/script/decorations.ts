/** What the script shows beside its words: steps' numbers, the selected step, problems and what others wrote. */
import { RangeSetBuilder, StateEffect, StateField, type EditorState, type Text } from "@codemirror/state";
import { Decoration, EditorView, gutter, GutterMarker, WidgetType, type DecorationSet } from "@codemirror/view";
import type { Conflict } from "./textMerge";

export interface LineMessage {
  readonly line: number;
  readonly text: string;
  readonly severity: "error" | "warning";
}

/** A stretch of the text that is underlined; columns from 1, the end not included. */
export interface Underline {
  readonly line: number;
  readonly column: number;
  readonly endLine: number | null;
  readonly endColumn: number | null;
  readonly text: string;
}

export interface ScriptContent {
  readonly text: string;
  /** The step of each line of the text, or "". */
  readonly lines: readonly string[];
  readonly numbers: Readonly<Record<string, string>>;
  readonly messages: readonly LineMessage[];
  readonly underlines: readonly Underline[];
  readonly conflicts: readonly Conflict[];
  readonly selected: ReadonlySet<string>;
  readonly scrollTo: string | null;
  /** The element that tells of the problems, while there are some. */
  readonly describedBy: string | null;
}

const EMPTY: ScriptContent = {
  text: "",
  lines: [],
  numbers: {},
  messages: [],
  underlines: [],
  conflicts: [],
  selected: new Set(),
  scrollTo: null,
  describedBy: null,
};

export const setContent = StateEffect.define<ScriptContent>();

export const content = StateField.define<ScriptContent>({
  create: () => EMPTY,
  update: (value, transaction) =>
    transaction.effects.reduce((now, effect) => (effect.is(setContent) ? effect.value : now), value),
});

/** The step that a place in the text belongs to, or "". */
export function stepAt(state: EditorState, position: number): string {
  return state.field(content).lines[state.doc.lineAt(position).number - 1] ?? "";
}

class Message extends WidgetType {
  constructor(
    readonly text: string,
    readonly severity: string,
  ) {
    super();
  }

  override eq(other: Message): boolean {
    return other.text === this.text && other.severity === this.severity;
  }

  override toDOM(): HTMLElement {
    const element = document.createElement("span");
    element.className = "vipo-line-message";
    element.dataset.severity = this.severity;
    element.textContent = this.text;
    return element;
  }
}

class StepNumber extends GutterMarker {
  constructor(
    readonly number: string,
    readonly chosen: boolean,
  ) {
    super();
  }

  override eq(other: StepNumber): boolean {
    return other.number === this.number && other.chosen === this.chosen;
  }

  override toDOM(): HTMLElement {
    const element = document.createElement("span");
    element.className = "vipo-step";
    element.dataset.selected = String(this.chosen);
    element.textContent = this.number;
    return element;
  }
}

export const lineDecorations = EditorView.decorations.compute([content, "doc"], (state) =>
  decorateLines(state.doc, state.field(content)),
);

export const underlines = EditorView.decorations.compute([content, "doc"], (state) =>
  underline(state.doc, state.field(content)),
);

function decorateLines(doc: Text, now: ScriptContent): DecorationSet {
  const builder = new RangeSetBuilder<Decoration>();
  const met = new Set(now.conflicts.map((conflict) => conflict.line));
  for (let number = 1; number <= doc.lines; number += 1) {
    const line = doc.line(number);
    const step = now.lines[number - 1] ?? "";
    const message = now.messages.find((each) => each.line === number);
    const names = [
      step && now.selected.has(step) ? "vipo-line-selected" : "",
      message?.severity === "error" && now.underlines.length === 0 ? "vipo-line-error" : "",
      met.has(number) ? "vipo-line-met" : "",
    ].filter(Boolean);
    if (names.length > 0) builder.add(line.from, line.from, Decoration.line({ class: names.join(" ") }));
    if (message)
      builder.add(
        line.to,
        line.to,
        Decoration.widget({ widget: new Message(message.text, message.severity), side: 1 }),
      );
  }
  return builder.finish();
}

function underline(doc: Text, now: ScriptContent): DecorationSet {
  const ranges = now.underlines
    .filter((each) => each.line <= doc.lines)
    .map((each) => {
      const line = doc.line(each.line);
      const from = Math.min(line.from + each.column - 1, line.to);
      const sameLine = each.endLine === each.line && each.endColumn !== null;
      const to = sameLine ? Math.min(line.from + (each.endColumn ?? 0) - 1, line.to) : line.to;
      return { from: from < to ? from : Math.max(line.from, to - 1), to: Math.max(to, from), text: each.text };
    })
    .filter(({ from, to }) => from < to);
  return Decoration.set(
    ranges.map(({ from, to, text }) =>
      Decoration.mark({ class: "vipo-script-error", attributes: { title: text } }).range(from, to),
    ),
    true,
  );
}

export const numbersGutter = gutter({
  class: "vipo-steps",
  lineMarker(view, block) {
    const now = view.state.field(content);
    const index = view.state.doc.lineAt(block.from).number - 1;
    const step = now.lines[index] ?? "";
    if (!step || now.lines[index - 1] === step) return null;
    const number = now.numbers[step];
    return number ? new StepNumber(number, now.selected.has(step)) : null;
  },
  lineMarkerChange: (update) =>
    update.docChanged || update.transactions.some((each) => each.effects.some((effect) => effect.is(setContent))),
});

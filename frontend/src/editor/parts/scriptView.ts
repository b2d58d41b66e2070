/** CodeMirror, read-only: the script with the steps' numbers in the gutter and the problems in the lines. */
import { python } from "@codemirror/lang-python";
import { HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import { EditorState, RangeSetBuilder, StateEffect, StateField, type Text } from "@codemirror/state";
import {
  Decoration,
  EditorView,
  gutter,
  GutterMarker,
  lineNumbers,
  WidgetType,
  type DecorationSet,
} from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Diagnostic } from "../model/types";

export interface ScriptContent {
  readonly script: string;
  readonly lines: readonly string[];
  readonly numbers: Readonly<Record<string, string>>;
  readonly diagnostics: readonly Diagnostic[];
  readonly selected: ReadonlySet<string>;
  readonly scrollTo: string | null;
}

export interface ScriptView {
  show(content: ScriptContent): void;
  destroy(): void;
}

const EMPTY: ScriptContent = {
  script: "",
  lines: [],
  numbers: {},
  diagnostics: [],
  selected: new Set(),
  scrollTo: null,
};

const setContent = StateEffect.define<ScriptContent>();

const content = StateField.define<ScriptContent>({
  create: () => EMPTY,
  update: (value, transaction) =>
    transaction.effects.reduce((now, effect) => (effect.is(setContent) ? effect.value : now), value),
});

const decorations = EditorView.decorations.compute([content, "doc"], (state) =>
  decorate(state.doc, state.field(content)),
);

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

function decorate(doc: Text, now: ScriptContent): DecorationSet {
  const builder = new RangeSetBuilder<Decoration>();
  for (let number = 1; number <= doc.lines; number += 1) {
    const line = doc.line(number);
    const step = now.lines[number - 1] ?? "";
    const problem = now.diagnostics.find((each) => each.line === number);
    const names = [
      step && now.selected.has(step) ? "vipo-line-selected" : "",
      problem?.severity === "error" ? "vipo-line-error" : "",
    ].filter(Boolean);
    if (names.length > 0) builder.add(line.from, line.from, Decoration.line({ class: names.join(" ") }));
    if (problem)
      builder.add(
        line.to,
        line.to,
        Decoration.widget({ widget: new Message(problem.message, problem.severity), side: 1 }),
      );
  }
  return builder.finish();
}

const numbersGutter = gutter({
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
    update.transactions.some((each) => each.effects.some((effect) => effect.is(setContent))),
});

const colours = HighlightStyle.define([
  { tag: [tags.keyword, tags.controlKeyword, tags.definitionKeyword], color: "var(--c-kw)" },
  { tag: tags.string, color: "var(--c-str)" },
  { tag: [tags.number, tags.bool, tags.null], color: "var(--c-num)" },
  { tag: tags.self, color: "var(--c-self)" },
  { tag: [tags.function(tags.variableName), tags.function(tags.propertyName)], color: "var(--c-fn)" },
  { tag: tags.comment, color: "var(--c-com)" },
  { tag: tags.className, color: "var(--c-cls)" },
]);

export function openScript(parent: HTMLElement, label: string, onStep: (step: string) => void): ScriptView {
  const view = new EditorView({
    parent,
    state: EditorState.create({
      doc: "",
      extensions: [
        lineNumbers(),
        numbersGutter,
        python(),
        syntaxHighlighting(colours),
        content,
        decorations,
        EditorState.readOnly.of(true),
        EditorView.editable.of(false),
        EditorView.contentAttributes.of({ "aria-label": label, tabindex: "0" }),
        EditorView.domEventHandlers({
          mousedown: (event, target) => {
            const at = target.posAtCoords({ x: event.clientX, y: event.clientY });
            if (at === null) return false;
            const step = target.state.field(content).lines[target.state.doc.lineAt(at).number - 1];
            if (step) onStep(step);
            return false;
          },
        }),
      ],
    }),
  });
  return { show: (next) => show(view, next), destroy: () => view.destroy() };
}

function show(view: EditorView, next: ScriptContent): void {
  const before = view.state.field(content);
  const same = view.state.doc.toString() === next.script;
  view.dispatch({
    changes: same ? undefined : { from: 0, to: view.state.doc.length, insert: next.script },
    effects: setContent.of(next),
  });
  if (next.scrollTo === null || next.scrollTo === before.scrollTo) return;
  const line = next.lines.indexOf(next.scrollTo);
  if (line < 0 || line >= view.state.doc.lines) return;
  view.dispatch({ effects: EditorView.scrollIntoView(view.state.doc.line(line + 1).from, { y: "center" }) });
}

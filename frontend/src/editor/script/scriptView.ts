/** CodeMirror with the script: read by all, written by authors, never a trap for the keyboard. */
import { autocompletion, type CompletionSource } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { python } from "@codemirror/lang-python";
import { HighlightStyle, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { Annotation, EditorState, Transaction, type Extension } from "@codemirror/state";
import { EditorView, keymap, lineNumbers, type ViewUpdate } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import {
  content,
  lineDecorations,
  numbersGutter,
  setContent,
  stepAt,
  underlines,
  type ScriptContent,
} from "./decorations";
import { changesBetween } from "./textMerge";

export interface ScriptEvents {
  /** The person pointed at a step's line or moved the cursor there. */
  readonly onStep: (step: string) => void;
  readonly onType: (text: string) => void;
  readonly onFocus: (focused: boolean) => void;
  /** The person leaves by Escape. */
  readonly onLeave: () => void;
  readonly complete: CompletionSource;
}

export interface ScriptView {
  show(content: ScriptContent): void;
  destroy(): void;
}

const fromDrawing = Annotation.define<boolean>();

const colours = HighlightStyle.define([
  { tag: [tags.keyword, tags.controlKeyword, tags.definitionKeyword], color: "var(--c-kw)" },
  { tag: tags.string, color: "var(--c-str)" },
  { tag: [tags.number, tags.bool, tags.null], color: "var(--c-num)" },
  { tag: tags.self, color: "var(--c-self)" },
  { tag: [tags.function(tags.variableName), tags.function(tags.propertyName)], color: "var(--c-fn)" },
  { tag: tags.comment, color: "var(--c-com)" },
  { tag: tags.className, color: "var(--c-cls)" },
]);

export function openScript(parent: HTMLElement, label: string, canEdit: boolean, events: ScriptEvents): ScriptView {
  const view = new EditorView({
    parent,
    state: EditorState.create({
      doc: "",
      extensions: [
        lineNumbers(),
        numbersGutter,
        python(),
        indentUnit.of("    "),
        syntaxHighlighting(colours),
        content,
        lineDecorations,
        underlines,
        described(label),
        canEdit ? editing(events) : [EditorState.readOnly.of(true), EditorView.editable.of(false)],
        pointing(events),
      ],
    }),
  });
  return { show: (next) => show(view, next), destroy: () => view.destroy() };
}

function described(label: string): Extension {
  return EditorView.contentAttributes.of((view): Record<string, string> => {
    const by = view.state.field(content).describedBy;
    const problems = by ? { "aria-describedby": by, "aria-invalid": "true" } : undefined;
    return { "aria-label": label, tabindex: "0", ...problems };
  });
}

function editing(events: ScriptEvents): Extension {
  const leave = (view: EditorView) => {
    view.contentDOM.blur();
    events.onLeave();
    return true;
  };
  return [
    history(),
    autocompletion({ override: [events.complete], icons: false }),
    keymap.of([{ key: "Escape", run: leave }, ...defaultKeymap, ...historyKeymap, indentWithTab]),
    EditorView.updateListener.of((update) => {
      if (update.focusChanged) events.onFocus(update.view.hasFocus);
      if (isTyped(update)) events.onType(update.state.doc.toString());
    }),
  ];
}

function isTyped(update: ViewUpdate): boolean {
  return update.docChanged && !update.transactions.some((each) => each.annotation(fromDrawing));
}

/** The step follows the cursor, where a person put it; typing does not change what is selected. */
function pointing(events: ScriptEvents): Extension {
  return [
    EditorView.updateListener.of((update) => {
      if (!update.transactions.some((each) => each.isUserEvent("select"))) return;
      const step = stepAt(update.state, update.state.selection.main.head);
      const before = stepAt(update.startState, update.startState.selection.main.head);
      if (step && (step !== before || !update.state.field(content).selected.has(step))) events.onStep(step);
    }),
    EditorView.domEventHandlers({
      mousedown: (event, view) => {
        const at = view.posAtCoords({ x: event.clientX, y: event.clientY });
        const step = at === null ? "" : stepAt(view.state, at);
        if (step) events.onStep(step);
        return false;
      },
    }),
  ];
}

function show(view: EditorView, next: ScriptContent): void {
  const before = view.state.field(content);
  const text = view.state.doc.toString();
  view.dispatch({
    changes: text === next.text ? undefined : [...changesBetween(text, next.text)],
    effects: setContent.of(next),
    annotations: [fromDrawing.of(true), Transaction.addToHistory.of(false)],
  });
  if (next.scrollTo === null || next.scrollTo === before.scrollTo || view.hasFocus) return;
  const line = next.lines.indexOf(next.scrollTo);
  if (line < 0 || line >= view.state.doc.lines) return;
  view.dispatch({ effects: EditorView.scrollIntoView(view.state.doc.line(line + 1).from, { y: "center" }) });
}

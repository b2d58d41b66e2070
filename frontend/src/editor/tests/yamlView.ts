/** CodeMirror with the text of a test: Tab leaves it, the line that the parser refuses says why. */
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { EditorState, StateEffect, StateField, type Extension } from "@codemirror/state";
import type { TestFault } from "@/api/types";
import { textFaultWords } from "@/i18n/refusals";
import { Decoration, EditorView, keymap, lineNumbers, WidgetType, type DecorationSet } from "@codemirror/view";

export interface YamlView {
  show(text: string): void;
  mark(fault: TestFault | null): void;
  destroy(): void;
}

interface Told {
  readonly label: string;
  readonly describedBy: string;
  readonly readOnly: boolean;
  readonly onType: (text: string) => void;
}

class Why extends WidgetType {
  constructor(readonly why: string) {
    super();
  }

  override eq(other: Why): boolean {
    return other.why === this.why;
  }

  override toDOM(): HTMLElement {
    const element = document.createElement("span");
    element.className = "vipo-line-message";
    element.textContent = this.why;
    return element;
  }
}

const setFault = StateEffect.define<TestFault | null>();

const fault = StateField.define<TestFault | null>({
  create: () => null,
  update: (value, transaction) =>
    transaction.effects.reduce((now, effect) => (effect.is(setFault) ? effect.value : now), value),
});

const marked = EditorView.decorations.compute([fault, "doc"], (state): DecorationSet => {
  const now = state.field(fault);
  if (!now || now.line < 1 || now.line > state.doc.lines) return Decoration.none;
  const line = state.doc.line(now.line);
  return Decoration.set([
    Decoration.line({ class: "vipo-line-error" }).range(line.from),
    Decoration.widget({ widget: new Why(textFaultWords({ ...now, line: 0 }).text), side: 1 }).range(line.to),
  ]);
});

export function openYaml(parent: HTMLElement, told: Told): YamlView {
  const view = new EditorView({
    parent,
    state: EditorState.create({ doc: "", extensions: [lineNumbers(), fault, marked, described(told), editing(told)] }),
  });
  return {
    show: (text) => {
      const now = view.state.doc.toString();
      if (now !== text) view.dispatch({ changes: { from: 0, to: now.length, insert: text } });
    },
    mark: (found) => view.dispatch({ effects: setFault.of(found) }),
    destroy: () => view.destroy(),
  };
}

function described({ label, describedBy }: Told): Extension {
  return EditorView.contentAttributes.of((view): Record<string, string> => {
    const invalid: Record<string, string> = view.state.field(fault) ? { "aria-invalid": "true" } : {};
    return { "aria-label": label, "aria-describedby": describedBy, tabindex: "0", spellcheck: "false", ...invalid };
  });
}

function editing({ readOnly, onType }: Told): Extension {
  if (readOnly) return [EditorState.readOnly.of(true), EditorView.editable.of(false)];
  return [
    history(),
    keymap.of([...defaultKeymap, ...historyKeymap]),
    EditorView.updateListener.of((update) => {
      if (update.docChanged) onType(update.state.doc.toString());
    }),
  ];
}

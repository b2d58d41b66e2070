/** Type a few letters, go there. */
import { Modal } from "@mantine/core";
import { Search } from "lucide-react";
import { type KeyboardEvent, useState } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { useDevices, usePrograms, useSite } from "@/api/queries";
import { seesOperations } from "./findings/findings";
import styles from "./jump.module.css";

type PageName = "programs" | "devices" | "library" | "runs" | "map" | "operations";
const PAGES: PageName[] = ["programs", "devices", "library", "runs", "map"];
const OPERATIONS: PageName[] = ["operations"];

function useTargets(slug: string | undefined): JumpTarget[] {
  const { t } = useTranslation();
  const programs = usePrograms(slug).data ?? [];
  const devices = useDevices(slug).data ?? [];
  const role = useSite(slug).data?.role;
  const at = `/sites/${slug ?? ""}`;
  return [
    { kind: "page", name: t("shell.nav.home"), to: "/" },
    { kind: "page", name: t("shell.account.settings"), to: "/account" },
    ...(slug ? PAGES : []).concat(slug && seesOperations(role) ? OPERATIONS : []).map((page) => ({
      kind: "page" as const,
      name: t(`shell.nav.${page}`),
      to: `${at}/${page}`,
    })),
    ...(slug ? [{ kind: "page" as const, name: t("people.title"), to: `${at}/people` }] : []),
    ...programs.map((each) => ({ kind: "program" as const, name: each.name, to: `/programs/${each.id}` })),
    ...devices.map((each) => ({
      kind: "device" as const,
      name: each.name,
      also: each.id,
      to: `${at}/devices/${each.id}`,
    })),
  ];
}

export function JumpPalette({ slug, onClose }: { slug: string | undefined; onClose: () => void }) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const [query, setQuery] = useState("");
  const [chosen, setChosen] = useState(0);
  const found = findTargets(useTargets(slug), query).slice(0, 9);
  const go = (target: JumpTarget | undefined) => {
    if (!target) return;
    onClose();
    void navigate(target.to);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) setChosen((now) => (now + step + found.length) % Math.max(1, found.length));
    if (event.key === "Enter") go(found[chosen]);
    if (step) event.preventDefault();
  };
  return (
    <Modal.Root opened onClose={onClose} padding={0} size={520} yOffset="14vh" centered={false}>
      <Modal.Overlay />
      <Modal.Content aria-label={t("shell.jump.open")}>
        <label className={styles.field}>
          <Search size={17} aria-hidden="true" />
          <input
            data-autofocus
            role="combobox"
            aria-expanded={found.length > 0}
            aria-controls="jump-list"
            aria-activedescendant={found.length > 0 ? `jump-${chosen}` : undefined}
            aria-label={t("shell.jump.open")}
            placeholder={t("shell.jump.placeholder")}
            value={query}
            onChange={(event) => {
              setQuery(event.target.value);
              setChosen(0);
            }}
            onKeyDown={onKeyDown}
          />
        </label>
        <Found {...{ found, chosen, go, setChosen, onKeyDown }} />
      </Modal.Content>
    </Modal.Root>
  );
}

interface FoundProps {
  found: readonly JumpTarget[];
  chosen: number;
  go: (target: JumpTarget) => void;
  setChosen: (index: number) => void;
  onKeyDown: (event: KeyboardEvent) => void;
}

function Found({ found, chosen, go, setChosen, onKeyDown }: FoundProps) {
  const { t } = useTranslation();
  if (found.length === 0)
    return (
      <div id="jump-list" className={styles.list}>
        <p role="status" className={styles.none}>
          {t("shell.jump.none")}
        </p>
      </div>
    );
  return (
    <div id="jump-list" role="listbox" aria-label={t("shell.jump.results")} className={styles.list}>
      {found.map((target, index) => (
        <div
          key={target.to}
          id={`jump-${index}`}
          role="option"
          tabIndex={-1}
          aria-selected={index === chosen}
          className={styles.item}
          onClick={() => go(target)}
          onKeyDown={onKeyDown}
          onPointerMove={() => setChosen(index)}
        >
          <span className={styles.name}>{target.name}</span>
          <small>{t(`shell.jump.${target.kind}`)}</small>
        </div>
      ))}
    </div>
  );
}

export interface JumpTarget {
  kind: "page" | "program" | "device";
  name: string;
  /** Another word it is known by. */
  also?: string;
  to: string;
}

/** Those whose name holds every word of the query; names that begin with it come first. */
export function findTargets(targets: readonly JumpTarget[], query: string): JumpTarget[] {
  const wanted = query.trim().toLowerCase();
  const words = wanted.split(/\s+/).filter(Boolean);
  const text = (target: JumpTarget) => `${target.name} ${target.also ?? ""}`.toLowerCase();
  const found = targets.filter((target) => words.every((word) => text(target).includes(word)));
  const begins = (target: JumpTarget) => (target.name.toLowerCase().startsWith(wanted) ? 0 : 1);
  return wanted ? found.sort((a, b) => begins(a) - begins(b)) : found;
}

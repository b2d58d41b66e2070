/** Type a few letters: go there, or do it. */
import { Modal } from "@mantine/core";
import { Search } from "lucide-react";
import { type KeyboardEvent, useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { useMe } from "@/api/queries";
import { useOtherLanguage } from "@/i18n/other";
import { wordsOfKeys } from "../keys/keyNames";
import { useOffers } from "./offers";
import { recentsOf, rememberRecent } from "./recents";
import { findTargets, type Target } from "./search";
import { useTargets } from "./useTargets";
import styles from "./palette.module.css";

const MOST_SHOWN = 40;

export function Palette({ slug, onClose }: { slug: string | undefined; onClose: () => void }) {
  const { t } = useTranslation();
  const person = String(useMe().data?.user?.id ?? "");
  const [query, setQuery] = useState("");
  const [chosen, setChosen] = useState(0);
  const [told, setTold] = useState("");
  const found = useFound(slug, query, person);
  const go = (target: Target | undefined) => {
    if (!target) return;
    if (target.whyNot) return setTold(target.whyNot);
    rememberRecent(person, target.id);
    onClose();
    // When the palette has given the keyboard back: what runs may want it.
    requestAnimationFrame(() => target.run());
  };
  const type = (text: string) => {
    setQuery(text);
    setChosen(0);
    setTold("");
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) setChosen((now) => Math.min(found.length - 1, Math.max(0, now + step)));
    if (event.key === "Enter" && !event.nativeEvent.isComposing) go(found[chosen]);
    if (step || event.key === "Enter") event.preventDefault();
  };
  return (
    <Modal.Root opened onClose={onClose} padding={0} size={560} yOffset="12vh" centered={false}>
      <Modal.Overlay />
      <Modal.Content aria-label={t("shell.jump.open")}>
        <Field query={query} chosen={found.length > 0 ? chosen : null} onType={type} onKeyDown={onKeyDown} />
        <Found {...{ found, chosen, go, setChosen, onKeyDown }} />
        <p role="status" className="visually-hidden">
          {told}
        </p>
      </Modal.Content>
    </Modal.Root>
  );
}

interface FieldProps {
  query: string;
  /** Null where nothing is found. */
  chosen: number | null;
  onType: (text: string) => void;
  onKeyDown: (event: KeyboardEvent) => void;
}

function Field({ query, chosen, onType, onKeyDown }: FieldProps) {
  const { t } = useTranslation();
  return (
    <label className={styles.field}>
      <Search size={17} aria-hidden="true" />
      <input
        data-autofocus
        role="combobox"
        aria-expanded={chosen !== null}
        aria-controls="jump-list"
        aria-activedescendant={chosen === null ? undefined : `jump-${chosen}`}
        aria-label={t("shell.jump.open")}
        placeholder={t("shell.jump.placeholder")}
        value={query}
        onChange={(event) => onType(event.target.value)}
        onKeyDown={onKeyDown}
      />
    </label>
  );
}

/** What a sentence means comes before what has its words. */
function useFound(slug: string | undefined, query: string, person: string): readonly Target[] {
  const other = useOtherLanguage();
  const targets = useTargets(slug, other, query);
  const offer = useOffers((state) => state.offer);
  return useMemo(() => {
    const said = query.trim() ? (offer?.said(query, other) ?? []) : [];
    const had = new Set(said.map(({ id }) => id));
    const found = findTargets(targets, query, recentsOf(person)).filter(({ id }) => !had.has(id));
    return [...said, ...found].slice(0, MOST_SHOWN);
  }, [targets, offer, other, query, person]);
}

interface FoundProps {
  found: readonly Target[];
  chosen: number;
  go: (target: Target) => void;
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
        <Row
          key={target.id}
          target={target}
          index={index}
          chosen={index === chosen}
          onPress={() => go(target)}
          onPoint={() => setChosen(index)}
          onKeyDown={onKeyDown}
        />
      ))}
    </div>
  );
}

interface RowProps {
  target: Target;
  index: number;
  chosen: boolean;
  onPress: () => void;
  onPoint: () => void;
  onKeyDown: (event: KeyboardEvent) => void;
}

function Row({ target, index, chosen, onPress, onPoint, onKeyDown }: RowProps) {
  const { t } = useTranslation();
  const { icon: Icon, name, keys, whyNot, kind } = target;
  const detail = whyNot ?? target.detail;
  return (
    <div
      id={`jump-${index}`}
      role="option"
      tabIndex={-1}
      aria-selected={chosen}
      aria-disabled={whyNot ? true : undefined}
      className={styles.item}
      ref={(row) => {
        if (chosen) row?.scrollIntoView({ block: "nearest" });
      }}
      // The field keeps the keyboard.
      onPointerDown={(event) => event.preventDefault()}
      onClick={onPress}
      onKeyDown={onKeyDown}
      onPointerMove={onPoint}
    >
      <span className={styles.icon}>{Icon ? <Icon size={17} /> : null}</span>
      <span className={styles.what}>
        <span className={styles.name}>{name}</span>
        {detail ? <span className={styles.detail}>{detail}</span> : null}
      </span>
      {keys ? <kbd>{wordsOfKeys(keys, (key) => t(`shell.keys.${key}`, key))}</kbd> : null}
      <small>{t(`shell.jump.${kind}`)}</small>
    </div>
  );
}

/** What is asked before a member's access gets an end, is taken away, or is given up. */
import { Button, Modal, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useQueryClient } from "@tanstack/react-query";
import { useState, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { keys } from "@/api/queries";
import type { Member, MemberDetail } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatMoment } from "@/i18n/format";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";
import { dayOf, endOfDay, useChangeMember, useLeave, useMember, useRemoveMember, useResetFactor } from "./people";
import styles from "./settings.module.css";

interface OfMember {
  slug: string;
  member: Member;
  onClose: () => void;
}

function Problem({ error }: { error: Error | null }) {
  const { t } = useTranslation();
  return error ? <p role="alert">{problemText(error, t("shell.problem.screen"))}</p> : null;
}

export function AccessEnd({ slug, member, onClose }: OfMember) {
  const { t } = useTranslation();
  useReturnFocus();
  const [day, setDay] = useState(member.ends_at ? dayOf(new Date(member.ends_at)) : "");
  const change = useChangeMember(slug, useTellUnseen());
  const { name } = member;
  const set = (ends_at: string | null) =>
    change.mutate(
      { id: member.id, ends_at },
      {
        onSuccess: () => {
          const when = ends_at ? formatMoment(ends_at) : "";
          notifications.show({ message: t(ends_at ? "people.end.done" : "people.end.never", { name, when }) });
          onClose();
        },
      },
    );
  const end = endOfDay(day);
  return (
    <Modal opened onClose={onClose} title={t("people.end.title", { name })} size={440}>
      <form
        className={pages.form}
        onSubmit={(event) => {
          event.preventDefault();
          if (end) set(end);
        }}
      >
        <p>{t("people.end.text", { name })}</p>
        <TextInput
          type="date"
          label={t("people.end.day")}
          min={dayOf(new Date())}
          data-autofocus
          value={day}
          onChange={(event) => setDay(event.currentTarget.value)}
        />
        <Problem error={change.error} />
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose}>
            {t("people.cancel")}
          </Button>
          {member.ends_at ? (
            <Button variant="default" onClick={() => set(null)}>
              {t("people.end.none")}
            </Button>
          ) : null}
          <Button type="submit" loading={change.isPending} disabled={!end}>
            {t("people.end.save")}
          </Button>
        </div>
      </form>
    </Modal>
  );
}

function Ending({ ending }: { ending: MemberDetail["ending"] }) {
  const { t } = useTranslation();
  const { tokens, invitations } = ending;
  return (
    <ul className={styles.ending}>
      <li>{t("people.remove.pages")}</li>
      {tokens.length > 0 ? (
        <li>{t("people.remove.tokens", { count: tokens.length, names: tokens.join(", ") })}</li>
      ) : null}
      {invitations > 0 ? <li>{t("people.remove.invitations", { count: invitations })}</li> : null}
      {ending.signs_out ? <li>{t("people.remove.signsOut")}</li> : null}
    </ul>
  );
}

interface AskProps {
  title: string;
  go: string;
  stay: string;
  busy: boolean;
  disabled?: boolean;
  error: Error | null;
  onGo: () => void;
  onClose: () => void;
  children: ReactNode;
}

function Ask({ title, go, stay, busy, disabled, error, onGo, onClose, children }: AskProps) {
  return (
    <Modal opened onClose={onClose} title={title} size={460}>
      <div className={pages.form}>
        {children}
        <Problem error={error} />
        <div className={pages.buttons}>
          <Button variant="default" onClick={onClose} data-autofocus>
            {stay}
          </Button>
          <Button className={pages.danger} loading={busy} disabled={disabled} onClick={onGo}>
            {go}
          </Button>
        </div>
      </div>
    </Modal>
  );
}

interface RemoveProps extends OfMember {
  /** Who has the focus when the member and this question are gone. */
  afterwards: () => HTMLElement | null;
}

export function AskRemove({ slug, member, onClose, afterwards }: RemoveProps) {
  const { t } = useTranslation();
  const goOnElsewhere = useReturnFocus(afterwards);
  const known = useMember(slug, member.id);
  const remove = useRemoveMember(slug, useTellUnseen());
  const { name } = member;
  const done = () => {
    notifications.show({ message: t("people.remove.done", { name }) });
    goOnElsewhere();
    onClose();
  };
  return (
    <Ask
      title={t("people.remove.title", { name })}
      go={t("people.remove.go")}
      stay={t("people.remove.keep")}
      busy={remove.isPending}
      disabled={!known.data}
      error={remove.error ?? known.error}
      onGo={() => remove.mutate(member.id, { onSuccess: done })}
      onClose={onClose}
    >
      <p>{t("people.remove.text")}</p>
      {known.data ? <Ending ending={known.data.ending} /> : null}
      {known.data?.ending.wall_screens_left.length ? <WallsLeft names={known.data.ending.wall_screens_left} /> : null}
      <p>{t("people.remove.keeps")}</p>
    </Ask>
  );
}

/** Screens in a hall do not go dark by themselves; but whoever kept such a link goes on watching the site. */
function WallsLeft({ names }: { names: readonly string[] }) {
  const { t } = useTranslation();
  return <p>{t("people.remove.wallScreens", { count: names.length, names: names.join(", ") })}</p>;
}

export function AskLeave({ slug, onClose }: Omit<OfMember, "member">) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const navigate = useNavigate();
  useReturnFocus();
  const leave = useLeave(slug, useTellUnseen());
  /** Also where the page has closed before the answer: it does for who is no member any more. */
  const go = () =>
    leave.mutateAsync().then(
      () => {
        void queries.invalidateQueries({ queryKey: keys.sites });
        return navigate("/");
      },
      () => {}, // told in the dialog
    );
  return (
    <Ask
      title={t("people.leave.title")}
      go={t("people.leave.go")}
      stay={t("people.leave.stay")}
      busy={leave.isPending}
      error={leave.error}
      onGo={() => void go()}
      onClose={onClose}
    >
      <p>{t("people.leave.text")}</p>
    </Ask>
  );
}

export function AskReset({ slug, member, onClose }: OfMember) {
  const { t } = useTranslation();
  useReturnFocus();
  const reset = useResetFactor(slug, useTellUnseen());
  const { name } = member;
  const go = () =>
    reset.mutate(member.id, {
      onSuccess: () => {
        notifications.show({ message: t("factor.reset.done", { name }) });
        onClose();
      },
    });
  return (
    <Modal opened onClose={onClose} title={t("factor.reset.title", { name })} size={440}>
      <div className={pages.form}>
        <p>{t("factor.reset.text", { name })}</p>
        <Problem error={reset.error} />
        <div className={pages.buttons}>
          <Button variant="default" data-autofocus onClick={onClose}>
            {t("factor.reset.keep")}
          </Button>
          <Button color="red" loading={reset.isPending} onClick={go}>
            {t("factor.reset.go")}
          </Button>
        </div>
      </div>
    </Modal>
  );
}

/** One's own second factor: set up with a picture and a code, recovery codes, and its end. */
import { Button, Modal, PasswordInput, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useRef, useState, type FormEvent, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem } from "@/api/client";
import type { Factor, NewFactor, RecoveryCodes } from "@/api/types";
import { Panel } from "@/design/Panel";
import { SecretField } from "@/design/SecretField";
import { takeKeyboard } from "@/design/takeKeyboard";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatMoment } from "@/i18n/format";
import { LoadProblem } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import pages from "../pages.module.css";
import styles from "./account.module.css";
import { Told } from "./Told";
import { useWaysIn } from "./waysIn";

const PATH = "/me/second-factor";
const KEY = ["me", "factor"] as const;

type Doing = "begin" | "renew" | "off";

interface Proof {
  password: string;
  code: string;
}

/** Keeps the dialog open, or lets it be closed again. */
type Hold = (isHeld: boolean) => void;

/** Something that is done with the own password: what is told once is shown at once, then all is read anew. */
function useProven<Told>(path: string, onTold: (told: Told) => void, hold: Hold) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (proof: Proof) => api.post<Told>(path, proof),
    onSuccess: (told) => {
      onTold(told);
      return queries.invalidateQueries();
    },
    onError: useTellUnseen(),
    onMutate: () => hold(true),
    onSettled: () => hold(false),
  });
}

interface ProofFormProps {
  /** Which code is asked for; none before there is a factor. */
  code?: "code" | "anyCode";
  go: string;
  error: Error | null;
  busy: boolean;
  children?: ReactNode;
  /** Known already, so not asked for. */
  password?: string;
  onSend: (proof: Proof) => void;
  onClose: () => void;
}

/** Whether one proves oneself by a password: who has none has signed in by their provider just now. */
const useHasPassword = () => useWaysIn().data?.has_password !== false;

function ProofForm({ code, go, error, busy, children, password, onSend, onClose }: ProofFormProps) {
  const { t } = useTranslation();
  const [proof, setProof] = useState<Proof>({ password: password ?? "", code: "" });
  const hasPassword = useHasPassword();
  const refusedFor = error instanceof ApiProblem ? error.code : "";
  const send = (event: FormEvent) => {
    event.preventDefault();
    onSend(proof);
  };
  return (
    <form className={`${pages.form} ${styles.form}`} onSubmit={send}>
      {children}
      {hasPassword ? null : <p>{t("signOn.fresh")}</p>}
      {password === undefined && hasPassword ? (
        <PasswordInput
          label={t("factor.password")}
          autoComplete="current-password"
          required
          withAsterisk={false}
          data-autofocus
          value={proof.password}
          error={refusedFor === "wrong_old_password"}
          onChange={(event) => setProof({ ...proof, password: event.target.value })}
        />
      ) : null}
      {code ? (
        <TextInput
          label={t(`factor.${code}`)}
          description={code === "code" ? t("factor.codeHint") : undefined}
          autoComplete="one-time-code"
          required
          withAsterisk={false}
          maxLength={40}
          // The dialog is open already where the password is known: nothing else brings the keyboard here.
          ref={password === undefined ? undefined : takeKeyboard}
          value={proof.code}
          error={refusedFor === "wrong_code"}
          onChange={(event) => setProof({ ...proof, code: event.target.value })}
        />
      ) : null}
      <Told error={error} done="" />
      <div className={pages.buttons}>
        <Button variant="default" disabled={busy} onClick={onClose}>
          {t("factor.cancel")}
        </Button>
        <Button
          type="submit"
          loading={busy}
          disabled={(hasPassword && !proof.password) || (code !== undefined && !proof.code)}
        >
          {go}
        </Button>
      </div>
    </form>
  );
}

function CodesShown({ codes, note, onClose }: { codes: readonly string[]; note?: string; onClose: () => void }) {
  const { t } = useTranslation();
  return (
    <div className={pages.form}>
      <p ref={takeKeyboard} className={styles.told} tabIndex={-1}>
        {t("factor.codesText")}
      </p>
      <ol className={styles.codes} aria-label={t("factor.codes")}>
        {codes.map((code) => (
          <li key={code}>
            <code>{code}</code>
          </li>
        ))}
      </ol>
      <SecretField
        label={t("factor.codes")}
        value={codes.join(" ")}
        copy={t("factor.codesCopy")}
        copied={t("factor.copied")}
      />
      {note ? <p>{note}</p> : null}
      <Button onClick={onClose}>{t("factor.have")}</Button>
    </div>
  );
}

interface CodesProps {
  onCodes: (codes: readonly string[]) => void;
  hold: Hold;
  onClose: () => void;
}

/** The app's secret as a picture and as text, and the code by which the app shows that it has it. */
function Confirm({ made, password, onCodes, hold, onClose }: CodesProps & { made: NewFactor; password: string }) {
  const { t } = useTranslation();
  const confirm = useProven<RecoveryCodes>(`${PATH}/confirm`, ({ codes }) => onCodes(codes), hold);
  return (
    <ProofForm
      code="code"
      go={t("factor.confirm")}
      error={confirm.error}
      busy={confirm.isPending}
      password={password}
      onSend={(proof) => confirm.mutate(proof)}
      onClose={onClose}
    >
      <p>{t("factor.scan")}</p>
      <img className={styles.picture} src={made.picture} alt={t("factor.picture")} />
      <SecretField label={t("factor.secret")} value={made.secret} copy={t("factor.copy")} copied={t("factor.copied")} />
    </ProofForm>
  );
}

function SetUp({ hold, ...rest }: CodesProps) {
  const { t } = useTranslation();
  const [made, setMade] = useState<{ factor: NewFactor; password: string } | null>(null);
  const begin = useMutation({
    mutationFn: ({ password }: Proof) => api.post<NewFactor>(PATH, { password }),
    onSuccess: (factor, { password }) => setMade({ factor, password }),
    onMutate: () => hold(true),
    onSettled: () => hold(false),
  });
  if (made) return <Confirm made={made.factor} password={made.password} hold={hold} {...rest} />;
  return (
    <ProofForm
      go={t("factor.go")}
      error={begin.error}
      busy={begin.isPending}
      onSend={(proof) => begin.mutate(proof)}
      onClose={rest.onClose}
    />
  );
}

function Renew({ onCodes, hold, onClose }: CodesProps) {
  const { t } = useTranslation();
  const renew = useProven<RecoveryCodes>(`${PATH}/recovery-codes`, ({ codes }) => onCodes(codes), hold);
  return (
    <ProofForm
      code="anyCode"
      go={t("factor.renew")}
      error={renew.error}
      busy={renew.isPending}
      onSend={(proof) => renew.mutate(proof)}
      onClose={onClose}
    >
      <p>{t("factor.renewText")}</p>
    </ProofForm>
  );
}

function TurnOff({ onDone, hold, onClose }: { onDone: () => void; hold: Hold; onClose: () => void }) {
  const { t } = useTranslation();
  const tell = () => notifications.show({ message: t("factor.turnedOff") });
  const off = useProven<Factor>(`${PATH}/off`, tell, hold);
  return (
    <ProofForm
      code="anyCode"
      go={t("factor.turnOff")}
      error={off.error}
      busy={off.isPending}
      onSend={(proof) => off.mutate(proof, { onSuccess: onDone })}
      onClose={onClose}
    >
      <p>{t("factor.offText")}</p>
    </ProofForm>
  );
}

const TITLES: Readonly<Record<Doing, string>> = {
  begin: "factor.begin",
  renew: "factor.renewTitle",
  off: "factor.offTitle",
};

interface DialogProps {
  doing: Doing;
  onClose: () => void;
  /** Who has the focus when the dialog is gone, and with it the button that opened it. */
  otherwise: () => HTMLElement | null;
}

function Dialog({ doing, onClose, otherwise }: DialogProps) {
  const { t } = useTranslation();
  const goOnElsewhere = useReturnFocus(otherwise);
  const [codes, setCodes] = useState<readonly string[] | null>(null);
  // Neither before it is known what comes of a proof, nor where codes are shown, by a slip of the hand.
  const [isHeld, hold] = useState(false);
  const isKept = isHeld || codes !== null;
  const show = (told: readonly string[]) => {
    goOnElsewhere();
    setCodes(told);
  };
  const done = () => {
    goOnElsewhere();
    onClose();
  };
  const note = doing === "begin" ? t("factor.elsewhere") : undefined;
  return (
    <Modal
      opened
      onClose={onClose}
      closeOnEscape={!isKept}
      withCloseButton={!isKept}
      title={t(codes ? "factor.codes" : TITLES[doing])}
      size={460}
    >
      {codes ? <CodesShown codes={codes} note={note} onClose={onClose} /> : null}
      {!codes && doing === "begin" ? <SetUp onCodes={show} hold={hold} onClose={onClose} /> : null}
      {!codes && doing === "renew" ? <Renew onCodes={show} hold={hold} onClose={onClose} /> : null}
      {!codes && doing === "off" ? <TurnOff onDone={done} hold={hold} onClose={onClose} /> : null}
    </Modal>
  );
}

export function SecondFactor() {
  const { t } = useTranslation();
  const factor = useQuery({ queryKey: KEY, queryFn: () => api.get<Factor>(PATH) });
  const [doing, setDoing] = useState<Doing | null>(null);
  const heading = useRef<HTMLHeadingElement>(null);
  if (factor.isLoadingError) return <LoadProblem error={factor.error} again={() => void factor.refetch()} />;
  if (!factor.data) return null;
  const { since, recovery_codes: left } = factor.data;
  return (
    <Panel className={styles.card} role="region" aria-labelledby="second-factor">
      <div className={styles.form}>
        <div>
          <h2 ref={heading} tabIndex={-1} id="second-factor">
            {t("factor.title")}
          </h2>
          <p>{since ? t("factor.on", { when: formatMoment(since) }) : t("factor.off")}</p>
          {since ? <p>{t("factor.left", { count: left })}</p> : null}
        </div>
        {since ? (
          <div className={styles.row}>
            <Button variant="default" onClick={() => setDoing("renew")}>
              {t("factor.renew")}
            </Button>
            <Button variant="default" c="var(--error)" onClick={() => setDoing("off")}>
              {t("factor.turnOff")}
            </Button>
          </div>
        ) : (
          <Button variant="default" onClick={() => setDoing("begin")}>
            {t("factor.begin")}
          </Button>
        )}
      </div>
      {doing ? <Dialog doing={doing} onClose={() => setDoing(null)} otherwise={() => heading.current} /> : null}
    </Panel>
  );
}

/** One's own second factor: set up with a picture and a code, recovery codes, and its end. */
import { Button, Modal, PasswordInput, TextInput } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useState, type FormEvent, type ReactNode } from "react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem } from "@/api/client";
import type { Factor, NewFactor, RecoveryCodes } from "@/api/types";
import { Panel } from "@/design/Panel";
import { SecretField } from "@/design/SecretField";
import { takeKeyboard } from "@/design/takeKeyboard";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatMoment } from "@/i18n/format";
import { LoadProblem } from "@/shell/LoadProblem";
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

/** Something that is done with the own password; how the factor stands is read anew afterwards. */
function useProven<Told>(path: string, onTold: (told: Told, proof: Proof) => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (proof: Proof) => api.post<Told>(path, proof),
    onSuccess: async (told, proof) => {
      await queries.invalidateQueries();
      onTold(told, proof);
    },
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
        <Button variant="default" onClick={onClose}>
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

/** The app's secret as a picture and as text, and the code by which the app shows that it has it. */
function Confirm({
  made,
  password,
  onCodes,
  onClose,
}: {
  made: NewFactor;
  password: string;
  onCodes: (codes: readonly string[]) => void;
  onClose: () => void;
}) {
  const { t } = useTranslation();
  const confirm = useProven<RecoveryCodes>(`${PATH}/confirm`, ({ codes }) => onCodes(codes));
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

function SetUp({ onCodes, onClose }: { onCodes: (codes: readonly string[]) => void; onClose: () => void }) {
  const { t } = useTranslation();
  const [made, setMade] = useState<{ factor: NewFactor; password: string } | null>(null);
  const begin = useMutation({
    mutationFn: ({ password }: Proof) => api.post<NewFactor>(PATH, { password }),
    onSuccess: (factor, { password }) => setMade({ factor, password }),
  });
  if (made) return <Confirm made={made.factor} password={made.password} onCodes={onCodes} onClose={onClose} />;
  return (
    <ProofForm
      go={t("factor.go")}
      error={begin.error}
      busy={begin.isPending}
      onSend={(proof) => begin.mutate(proof)}
      onClose={onClose}
    />
  );
}

function Renew({ onCodes, onClose }: { onCodes: (codes: readonly string[]) => void; onClose: () => void }) {
  const { t } = useTranslation();
  const renew = useProven<RecoveryCodes>(`${PATH}/recovery-codes`, ({ codes }) => onCodes(codes));
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

function TurnOff({ onClose }: { onClose: () => void }) {
  const { t } = useTranslation();
  const off = useProven<Factor>(`${PATH}/off`, () => {
    notifications.show({ message: t("factor.turnedOff") });
    onClose();
  });
  return (
    <ProofForm
      code="anyCode"
      go={t("factor.turnOff")}
      error={off.error}
      busy={off.isPending}
      onSend={(proof) => off.mutate(proof)}
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

function Dialog({ doing, onClose }: { doing: Doing; onClose: () => void }) {
  const { t } = useTranslation();
  useReturnFocus();
  const [codes, setCodes] = useState<readonly string[] | null>(null);
  const note = doing === "begin" ? t("factor.elsewhere") : undefined;
  return (
    <Modal
      opened
      onClose={onClose}
      closeOnEscape={codes === null}
      withCloseButton={codes === null}
      title={t(codes ? "factor.codes" : TITLES[doing])}
      size={460}
    >
      {codes ? <CodesShown codes={codes} note={note} onClose={onClose} /> : null}
      {!codes && doing === "begin" ? <SetUp onCodes={setCodes} onClose={onClose} /> : null}
      {!codes && doing === "renew" ? <Renew onCodes={setCodes} onClose={onClose} /> : null}
      {!codes && doing === "off" ? <TurnOff onClose={onClose} /> : null}
    </Modal>
  );
}

export function SecondFactor() {
  const { t } = useTranslation();
  const factor = useQuery({ queryKey: KEY, queryFn: () => api.get<Factor>(PATH) });
  const [doing, setDoing] = useState<Doing | null>(null);
  if (factor.isLoadingError) return <LoadProblem error={factor.error} again={() => void factor.refetch()} />;
  if (!factor.data) return null;
  const { since, recovery_codes: left } = factor.data;
  return (
    <Panel className={styles.card} role="region" aria-labelledby="second-factor">
      <div className={styles.form}>
        <div>
          <h2 id="second-factor">{t("factor.title")}</h2>
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
      {doing ? <Dialog doing={doing} onClose={() => setDoing(null)} /> : null}
    </Panel>
  );
}
